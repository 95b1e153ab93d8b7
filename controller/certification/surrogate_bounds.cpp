#include "controller/certification/surrogate_bounds.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "controller/certification/disc_surrogate.hpp"

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
                                      CertificateEffort effort, Eigen::Index stage,
                                      const SurrogateStage& surrogate, const PathTilt& tilt,
                                      Eigen::VectorXd& shares) {
  if (surrogate.leaving >= 1.0) return {.markov = 1.0, .smooth = 1.0};
  const bool every = effort == CertificateEffort::kEvery;
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
                             .worthwhile = every ? kNegligibleBound : kWorthwhile};
    for (const RegionPointer& region : disc.regions) {
      const double before = sum.smooth;
      region->add_probability(stage, state, sum);
      shares[part++] = sum.smooth - before;
    }
  }
  return {.markov = std::min(1.0, sum.markov), .smooth = std::min(1.0, sum.smooth)};
}

}  // namespace

double surrogate_law_bound(const UnsafeSet& unsafe, Eigen::Index stage,
                           const SurrogateStage& surrogate) {
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
                             .worthwhile = kNegligibleBound};
    for (const RegionPointer& region : disc.regions) region->add_probability(stage, state, sum);
  }
  return std::min(1.0, sum.smooth);
}

SurrogateBounds surrogate_bounds(const PredictedMotion& motion, const UnsafeSet& unsafe,
                                 CertificateEffort effort, const Executor& run,
                                 const PathTilt& tilt, std::vector<RegionProbability> known) {
  SurrogateBounds result{.surrogates = {}, .bounds = std::move(known), .shares = {}};
  std::vector<RegionProbability>& least = result.bounds;
  const Eigen::Index horizon = motion.policy.horizon();
  if (least.empty()) least.assign(horizon, {.markov = 1.0, .smooth = 1.0});
  for (const double core : {kWideCore, kNarrowCore}) {
    std::vector<SurrogateStage> surrogates = affine_surrogates(motion, core, tilt);
    Eigen::MatrixXd shares = Eigen::MatrixXd::Ones(region_count(unsafe), horizon);
    const auto stage = [&](int k) {
      // Neither bound can be less than the probability of leaving, nor C3 less than C4.
      if (least[k].markov <= surrogates[k + 1].leaving) return;
      Eigen::VectorXd added = shares.col(k);
      const RegionProbability bounds = bounds_of_surrogate(
          motion, unsafe, effort, static_cast<Eigen::Index>(k) + 1, surrogates[k + 1], tilt, added);
      shares.col(k) = added;
      least[k] = {.markov = std::min(least[k].markov, bounds.markov),
                  .smooth = std::min(least[k].smooth, bounds.smooth)};
    };
    run(static_cast<int>(least.size()), stage);
    double largest = 0.0;
    for (const RegionProbability& bounds : least) largest = std::max(largest, bounds.smooth);
    const bool in_use = surrogates.back().leaving > 0.0;
    if (result.surrogates.empty()) {
      result.surrogates = std::move(surrogates);
      result.shares = std::move(shares);
    }
    // Without a core in use the narrow one changes nothing.
    if (largest < kTryNarrow || !in_use) break;
  }
  return result;
}

}  // namespace qsmpc::controller
