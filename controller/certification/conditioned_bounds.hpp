// C5: the path's noise is held near the places of a grid along the functionals that bend the motion
// most, and C3 and C4 are taken under each of the tilted laws (docs/theory/conditioning.md).
#pragma once

#include <vector>

#include "controller/certification/surrogate_bounds.hpp"
#include "controller/parallel.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

/// Bounds of stages 1 … horizon, at most 1. 1 where `plain`, the motion's C3 and C4, is hardly
/// larger than it would be without errors, and everywhere if the motion has a model error.
[[nodiscard]] std::vector<double> conditioned_bounds(const PredictedMotion& motion,
                                                     const UnsafeSet& unsafe,
                                                     const SurrogateBounds& plain,
                                                     const Executor& run);

}  // namespace qsmpc::controller
