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
  /// parts x horizon: what each region of each disc adds to C4 of `surrogates`, disc by disc,
  /// without the probability of leaving; 1 where it was not computed.
  Eigen::MatrixXd shares;
};

/// Where the bounds are large, for which stages the surrogate with the narrow core is tried.
enum class NarrowCore {
  kAlways,     ///< for all
  kIfTelling,  ///< for one stage, and for all if that shows that the others may gain much: in
               ///< planning, where bounds that large seldom decide anything
};

/// Needs neither particles nor their distances: the motion's prediction may be empty. Where the
/// bounds are large, the surrogate with the narrow core is also tried: its core is left more often,
/// but its residuals are smaller: for all stages, or in the way that `narrow` says. With the least
/// effort C3 (`markov`) is searched for only as far as it may lower C4, and is looser elsewhere.
[[nodiscard]] SurrogateBounds surrogate_bounds(const PredictedMotion& motion,
                                               const UnsafeSet& unsafe, CertificateEffort effort,
                                               const Executor& run,
                                               NarrowCore narrow = NarrowCore::kAlways);

/// C4 with one core and under the tilted law of the noise, C3 only as far as it may lower C4; a
/// tilt only for motions without a model error. worthwhile: per stage, the contribution of a part
/// of the unsafe set up to which no long search is made; where infinite, the stage is not computed:
/// its bounds and shares are 1.
[[nodiscard]] SurrogateBounds tilted_surrogate_bounds(const PredictedMotion& motion,
                                                      const UnsafeSet& unsafe,
                                                      const Eigen::VectorXd& worthwhile,
                                                      const PathTilt& tilt, double core,
                                                      const Executor& run);

/// A bound of P(z ∈ U) for the surrogate z itself at `stage`: the value of the bounds above if z
/// equalled the state, hence NOT a bound for the state.
[[nodiscard]] double surrogate_law_bound(const UnsafeSet& unsafe, Eigen::Index stage,
                                         const SurrogateStage& surrogate, double worthwhile);

}  // namespace qsmpc::controller
