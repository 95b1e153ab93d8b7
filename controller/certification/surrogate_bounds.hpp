// C3 and C4 of all stages of a motion, from one search over surrogates.
#pragma once

#include <vector>

#include "controller/certification/affine_surrogate.hpp"
#include "controller/certification/certificate.hpp"
#include "controller/parallel.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

struct SurrogateBounds {
  std::vector<SurrogateStage> surrogates;  ///< stages 0 … horizon, with the wide core
  std::vector<RegionProbability> bounds;   ///< stages 1 … horizon, at most 1
};

/// Needs neither particles nor their distances: of the motion its prediction may be empty. Where
/// the bounds are large, the surrogate with the narrow core is tried, too: it is left more often,
/// and its residuals are smaller.
[[nodiscard]] SurrogateBounds surrogate_bounds(const PredictedMotion& motion,
                                               const UnsafeSet& unsafe, CertificateEffort effort,
                                               const Executor& run);

}  // namespace qsmpc::controller
