#include "controller/certification/surrogate_bounds.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "controller/certification/disc_surrogate.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// A region's contribution below which its bound is not refined further …
constexpr double kNegligibleBound = 1e-8;
// … and below which no long search is made.
constexpr double kWorthwhile = 1e-4;
// The bound from which the narrow core, which itself costs about 1e-2, may help.
constexpr double kTryNarrow = 0.03;

Eigen::Index region_count(const UnsafeSet& unsafe) {
  std::size_t count = 0;
  for (const DiscView& disc : unsafe.discs()) count += disc.regions.size();
  return static_cast<Eigen::Index>(count);
}

/// C3 and C4 of one stage, and each region's contribution to C4, which takes the better of the two
/// for every part of the unsafe set.
RegionProbability bounds_of_surrogate(const PredictedMotion& motion, const UnsafeSet& unsafe,
                                      double worthwhile, WantedBounds wanted, Eigen::Index stage,
                                      const SurrogateStage& surrogate, const PathTilt& tilt,
                                      Eigen::VectorXd& shares) {
  if (surrogate.leaving >= 1.0) return {.markov = 1.0, .smooth = 1.0};
  RegionProbability sum{.markov = surrogate.leaving, .smooth = surrogate.leaving};
  Eigen::Index part = 0;
  for (const DiscView& disc : unsafe.discs()) {
    const std::function<Eigen::MatrixXd(const std::vector<Eigen::Index>&)> smoothing =
        [&](const std::vector<Eigen::Index>& axes) {
          return disc_smoothing(motion, stage, axes, disc.placement, tilt);
        };
    const DiscSurrogate centre = disc_surrogate(surrogate, disc.placement);
    const SurrogateLaw state{.law = centre.law,
                             .error = centre.error,
                             .higher = centre.higher,
                             .smoothing = smoothing,
                             .worthwhile = worthwhile,
                             .wanted = wanted};
    for (const RegionPointer& region : disc.regions) {
      const double before = sum.smooth;
      region->add_probability(stage, state, sum);
      shares[part++] = sum.smooth - before;
    }
  }
  return {.markov = std::min(1.0, sum.markov), .smooth = std::min(1.0, sum.smooth)};
}

/// What is asked of the stages' bounds: per stage, the contribution of a part of the unsafe set up
/// to which no long search is made (infinite: the stage is not asked for), and which of the two.
struct Asked {
  const Eigen::VectorXd& worthwhile;
  WantedBounds wanted = WantedBounds::kBoth;
};

/// The bounds with one core, at most those that are `known` (else 1 each).
SurrogateBounds bounds_with_core(const PredictedMotion& motion, const UnsafeSet& unsafe,
                                 const Asked& asked, const PathTilt& tilt, double core,
                                 const Executor& run, std::vector<RegionProbability> known = {}) {
  const Eigen::Index horizon = motion.policy.horizon();
  SurrogateBounds result{.surrogates = affine_surrogates(motion, core, tilt),
                         .bounds = std::move(known),
                         .shares = Eigen::MatrixXd::Ones(region_count(unsafe), horizon)};
  std::vector<RegionProbability>& least = result.bounds;
  if (least.empty()) least.assign(horizon, {.markov = 1.0, .smooth = 1.0});
  const auto stage = [&](int k) {
    const SurrogateStage& surrogate = result.surrogates[k + 1];
    // No bound can be less than the probability of leaving; C3 is never less than C4.
    const double largest = asked.wanted == WantedBounds::kBoth ? least[k].markov : least[k].smooth;
    if (asked.worthwhile[k] == kInfinity || largest <= surrogate.leaving) return;
    Eigen::VectorXd added = result.shares.col(k);
    const RegionProbability bounds =
        bounds_of_surrogate(motion, unsafe, asked.worthwhile[k], asked.wanted,
                            static_cast<Eigen::Index>(k) + 1, surrogate, tilt, added);
    result.shares.col(k) = added;
    least[k] = {.markov = std::min(least[k].markov, bounds.markov),
                .smooth = std::min(least[k].smooth, bounds.smooth)};
  };
  run(static_cast<int>(horizon), stage);
  return result;
}

}  // namespace

double surrogate_law_bound(const UnsafeSet& unsafe, Eigen::Index stage,
                           const SurrogateStage& surrogate, double worthwhile) {
  const Eigen::Index dim = surrogate.law.mean.size();
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(dim);
  HigherNorms higher;
  for (Eigen::VectorXd& norms : higher) norms = none;
  const std::function<Eigen::MatrixXd(const std::vector<Eigen::Index>&)> smoothing =
      [dim](const std::vector<Eigen::Index>&) -> Eigen::MatrixXd {
    return Eigen::MatrixXd::Zero(dim, dim);
  };
  RegionProbability sum;
  for (const DiscView& disc : unsafe.discs()) {
    const DiscSurrogate centre = disc_surrogate(surrogate, disc.placement);
    const SurrogateLaw state{.law = centre.law,
                             .error = none,
                             .higher = higher,
                             .smoothing = smoothing,
                             .worthwhile = worthwhile,
                             .wanted = WantedBounds::kLeast};
    for (const RegionPointer& region : disc.regions) region->add_probability(stage, state, sum);
  }
  return std::min(1.0, sum.smooth);
}

SurrogateBounds tilted_surrogate_bounds(const PredictedMotion& motion, const UnsafeSet& unsafe,
                                        const Eigen::VectorXd& worthwhile, const PathTilt& tilt,
                                        double core, const Executor& run) {
  return bounds_with_core(
      motion, unsafe, {.worthwhile = worthwhile, .wanted = WantedBounds::kLeast}, tilt, core, run);
}

SurrogateBounds surrogate_bounds(const PredictedMotion& motion, const UnsafeSet& unsafe,
                                 CertificateEffort effort, const Executor& run,
                                 WantedBounds wanted) {
  const Eigen::VectorXd worthwhile = Eigen::VectorXd::Constant(
      motion.policy.horizon(),
      effort == CertificateEffort::kLeast ? kWorthwhile : kNegligibleBound);
  const Asked asked{.worthwhile = worthwhile, .wanted = wanted};
  SurrogateBounds result = bounds_with_core(motion, unsafe, asked, {}, kWideCore, run);
  double largest = 0.0;
  for (const RegionProbability& bounds : result.bounds) {
    largest = std::max(largest, bounds.smooth);
  }
  // Without a core in use the narrow one changes nothing.
  const bool in_use = result.surrogates.back().leaving > 0.0;
  if (largest >= kTryNarrow && in_use) {
    result.bounds =
        bounds_with_core(motion, unsafe, asked, {}, kNarrowCore, run, std::move(result.bounds))
            .bounds;
  }
  return result;
}

}  // namespace qsmpc::controller
