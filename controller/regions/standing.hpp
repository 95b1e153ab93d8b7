// The stationary part of a safe set.
#pragma once

#include "controller/regions/safe_set.hpp"

namespace qsmpc::controller {

/// The safe set without its moving obstacles.
[[nodiscard]] SafeSet standing(SafeSet safe_set);

}  // namespace qsmpc::controller
