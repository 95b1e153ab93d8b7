// Which part of the unsafe set a state is in.
//
//   if (unsafe_part(state, unsafe) == UnsafePart::kObstacle) …
#pragma once

#include <Eigen/Core>

#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

enum class UnsafePart {
  kNone,      ///< it is safe
  kBounds,    ///< outside of the bounds, or on them
  kObstacle,  ///< in an obstacle or touching it, whether within the bounds or not
};

/// The part that `point` (state_dim) is in at `stage`, 0 being the present; kNone exactly where its
/// clearance is positive or not a number.
[[nodiscard]] UnsafePart unsafe_part(const Eigen::Ref<const Eigen::VectorXd>& point,
                                     const UnsafeSet& unsafe, Eigen::Index stage = 0);

}  // namespace qsmpc::controller
