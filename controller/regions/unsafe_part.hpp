// Which part of the unsafe set a state is in.
//
//   if (unsafe_part(state, unsafe) == UnsafePart::kObstacle) …
#pragma once

#include <Eigen/Core>

#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

enum class UnsafePart {
  kNone,      ///< the state is safe
  kBounds,    ///< a disc of the body is outside the bounds or the road, or touches their edges
  kObstacle,  ///< a disc is in an obstacle or touches it, whether within the bounds or not
};

/// The part that the body at `state` (state_dim) is in at `stage`, 0 being the present; kNone
/// exactly where its clearance is positive. A state that is not finite is out of bounds.
[[nodiscard]] UnsafePart unsafe_part(const Eigen::Ref<const Eigen::VectorXd>& state,
                                     const UnsafeSet& unsafe, Eigen::Index stage = 0);

}  // namespace qsmpc::controller
