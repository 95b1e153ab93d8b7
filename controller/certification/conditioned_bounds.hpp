// C5: the path's noise is held near the points of a grid, along those of its linear functionals
// that make the motion most nonlinear, and C3 and C4 are computed under each of the tilted laws
// (docs/theory/conditioning.md).
#pragma once

#include <vector>

#include "controller/certification/surrogate_bounds.hpp"
#include "controller/parallel.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

struct ConditionedBounds {
  std::vector<double> stages;   ///< of stages 1 … horizon, at most 1
  std::vector<double> entries;  ///< as from first_entry_bounds; empty if nothing was conditioned
};

/// C5 and the first-entry bounds. A stage's bound is 1 where `plain`, the motion's C3 and C4, is
/// hardly larger than it would be without errors, and at all stages if the motion has a model
/// error.
[[nodiscard]] ConditionedBounds conditioned_bounds(const PredictedMotion& motion,
                                                   const UnsafeSet& unsafe,
                                                   const SurrogateBounds& plain,
                                                   const Executor& run);

}  // namespace qsmpc::controller
