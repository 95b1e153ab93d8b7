// C3 and C4 of all stages of a motion, from one search over surrogates.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/certification/affine_surrogate.hpp"
#include "controller/certification/certificate.hpp"
#include "controller/parallel.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

struct SurrogateBounds {
  std::vector<SurrogateStage> surrogates;  ///< stages 0 … horizon, with the wide core
  std::vector<RegionProbability> bounds;   ///< stages 1 … horizon, at most 1
  /// parts x horizon: what each region of each disc adds to C4 of `surrogates`, disc by disc, the
  /// probability of leaving aside; 1 where that was not worked out.
  Eigen::MatrixXd shares;
};

/// Needs neither particles nor their distances: of the motion its prediction may be empty. Where
/// the bounds are large, the surrogate with the narrow core is tried, too: it is left more often,
/// and its residuals are smaller. tilt: all of this under the tilted law of the noise; for motions
/// without a model error. known: bounds that there are already (else 1 each); of a stage nothing is
/// worked out that can't be less than these.
[[nodiscard]] SurrogateBounds surrogate_bounds(const PredictedMotion& motion,
                                               const UnsafeSet& unsafe, CertificateEffort effort,
                                               const Executor& run, const PathTilt& tilt = {},
                                               std::vector<RegionProbability> known = {});

/// A bound of P(z ∈ U), z the surrogate itself, at `stage`: what the bounds above come to where
/// nothing separates it from the state, and so no bound of the state.
[[nodiscard]] double surrogate_law_bound(const UnsafeSet& unsafe, Eigen::Index stage,
                                         const SurrogateStage& surrogate);

}  // namespace qsmpc::controller
