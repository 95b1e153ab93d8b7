#include "controller/regions/unsafe_part.hpp"

namespace qsmpc::controller {

UnsafePart unsafe_part(const Eigen::Ref<const Eigen::VectorXd>& point, const UnsafeSet& unsafe,
                       Eigen::Index stage) {
  for (const RegionPointer& obstacle : unsafe.obstacles()) {
    if (obstacle->signed_distance(stage, point) <= 0.0) return UnsafePart::kObstacle;
  }
  return unsafe.walls().signed_distance(stage, point) <= 0.0 ? UnsafePart::kBounds
                                                             : UnsafePart::kNone;
}

}  // namespace qsmpc::controller
