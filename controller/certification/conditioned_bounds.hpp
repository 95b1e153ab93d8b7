// C5: the path's noise is held near the points of a grid, along those of its linear functionals
// that make the motion most nonlinear, and C3 and C4 are computed under each of the tilted laws
// (docs/theory/conditioning.md).
#pragma once

#include <vector>

#include "controller/certification/certificate.hpp"
#include "controller/certification/surrogate_bounds.hpp"
#include "controller/parallel.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

struct ConditionedBounds {
  std::vector<double> stages;   ///< of stages 1 … horizon, at most 1
  std::vector<double> entries;  ///< as from first_entry_bounds; empty if nothing was conditioned
};

/// C5 and the first-entry bounds, as tight as `effort` allows. All stages' bounds are 1 where none
/// of `plain`, the motion's C3 and C4, is much larger than it would be without errors, and if the
/// motion has a model error.
[[nodiscard]] ConditionedBounds conditioned_bounds(const PredictedMotion& motion,
                                                   const UnsafeSet& unsafe,
                                                   const SurrogateBounds& plain,
                                                   CertificateEffort effort, const Executor& run);

}  // namespace qsmpc::controller
