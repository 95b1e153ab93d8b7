#include "controller/regions/standing.hpp"

namespace qsmpc::controller {

SafeSet standing(SafeSet safe_set) {
  std::erase_if(safe_set.obstacles, [](const Obstacle& one) { return one.motion.has_value(); });
  safe_set.forecast = nullptr;
  return safe_set;
}

}  // namespace qsmpc::controller
