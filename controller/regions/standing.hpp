// What of a safe set stands still.
#pragma once

#include "controller/regions/safe_set.hpp"

namespace qsmpc::controller {

/// The safe set without the obstacles that move.
[[nodiscard]] SafeSet standing(SafeSet safe_set);

}  // namespace qsmpc::controller
