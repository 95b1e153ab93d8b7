#include "controller/regions/unsafe_part.hpp"

namespace qsmpc::controller {
namespace {

/// Whether the disc's centre at `state` is in one of these regions.
template <class Regions>
bool in_any(const DiscView& disc, const Regions& regions,
            const Eigen::Ref<const Eigen::VectorXd>& state, Eigen::Index stage) {
  const Eigen::VectorXd centre = disc.placement.of(state);
  for (const RegionPointer& region : regions) {
    if (region->signed_distance(stage, centre) <= 0.0) return true;
  }
  return false;
}

}  // namespace

UnsafePart unsafe_part(const Eigen::Ref<const Eigen::VectorXd>& state, const UnsafeSet& unsafe,
                       Eigen::Index stage) {
  if (!state.allFinite()) return UnsafePart::kBounds;
  for (const DiscView& disc : unsafe.discs()) {
    if (in_any(disc, disc.obstacles(), state, stage)) return UnsafePart::kObstacle;
  }
  for (const DiscView& disc : unsafe.discs()) {
    if (in_any(disc, disc.borders(), state, stage)) return UnsafePart::kBounds;
  }
  return UnsafePart::kNone;
}

}  // namespace qsmpc::controller
