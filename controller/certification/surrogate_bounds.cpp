#include "controller/certification/surrogate_bounds.hpp"

#include <algorithm>
#include <functional>
#include <vector>

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
// It is tried for all stages only if it leaves less than the first share of one stage's bound, or
// if that stage's bound without errors is less than the second.
constexpr double kNarrowHelps = 0.97;
constexpr double kMostlyUnsafe = 0.5;

Eigen::Index region_count(const UnsafeSet& unsafe) {
  std::size_t count = 0;
  for (const DiscView& disc : unsafe.discs()) count += disc.regions.size();
  return static_cast<Eigen::Index>(count);
}

/// C3 and C4 of one stage, and each region's contribution to C4, which takes the better of the two
/// for every part of the unsafe set. With WantedBounds::kLeast all of these may be 1 if C4 is not
/// below `known`.
RegionProbability bounds_of_surrogate(const PredictedMotion& motion, const UnsafeSet& unsafe,
                                      double worthwhile, WantedBounds wanted, double known,
                                      Eigen::Index stage, const SurrogateStage& surrogate,
                                      const PathTilt& tilt, Eigen::VectorXd& shares) {
  if (surrogate.leaving >= 1.0) return {.markov = 1.0, .smooth = 1.0};
  RegionProbability sum{.markov = surrogate.leaving, .smooth = surrogate.leaving};
  Eigen::Index part = 0;
  for (const DiscView& disc : unsafe.discs()) {
    // Most regions ask in the plane of position.
    std::vector<Eigen::Index> last_axes;
    Eigen::MatrixXd last_smoothing;
    const std::function<Eigen::MatrixXd(const std::vector<Eigen::Index>&)> smoothing =
        [&](const std::vector<Eigen::Index>& axes) {
          if (axes != last_axes) {
            last_axes = axes;
            last_smoothing = disc_smoothing(motion, stage, axes, disc.placement, tilt);
          }
          return last_smoothing;
        };
    const DiscSurrogate centre = disc_surrogate(surrogate, disc.placement);
    SurrogateLaw state{.law = centre.law,
                       .error = centre.error,
                       .higher = centre.higher,
                       .smoothing = smoothing,
                       .worthwhile = worthwhile,
                       .wanted = wanted};
    for (const RegionPointer& region : disc.regions) {
      const double before = sum.smooth;
      state.useful = known - before;
      if (wanted == WantedBounds::kLeast && state.useful <= 0.0) {
        return {.markov = 1.0, .smooth = 1.0};
      }
      region->add_probability(stage, state, sum);
      shares[part++] = sum.smooth - before;
    }
  }
  return {.markov = std::min(1.0, sum.markov), .smooth = std::min(1.0, sum.smooth)};
}

/// What is asked of the stages' bounds: per stage, the contribution of a part of the unsafe set up
/// to which no long search is made (infinite: the stage is not asked for), and which of the two.
struct Asked {
  Eigen::VectorXd worthwhile;
  WantedBounds wanted = WantedBounds::kBoth;
};

/// Lowers bounds, which are 1 or known from other surrogates, to those of these surrogates (stages
/// 0 … horizon) where they are less. shares: as of SurrogateBounds, or null if they are not wanted.
void lower_bounds(const PredictedMotion& motion, const UnsafeSet& unsafe, const Asked& asked,
                  const PathTilt& tilt, const std::vector<SurrogateStage>& surrogates,
                  const Executor& run, std::vector<RegionProbability>& bounds,
                  Eigen::MatrixXd* shares) {
  const Eigen::Index regions = region_count(unsafe);
  const auto stage = [&](int k) {
    const SurrogateStage& surrogate = surrogates[k + 1];
    RegionProbability& least = bounds[k];
    // No bound can be less than the probability of leaving; C3 is never less than C4.
    const double largest = asked.wanted == WantedBounds::kBoth ? least.markov : least.smooth;
    if (asked.worthwhile[k] == kInfinity || largest <= surrogate.leaving) return;
    Eigen::VectorXd added = Eigen::VectorXd::Ones(regions);
    // Each share is wanted even where their sum exceeds what is known.
    const double known = shares == nullptr ? least.smooth : kInfinity;
    const RegionProbability found =
        bounds_of_surrogate(motion, unsafe, asked.worthwhile[k], asked.wanted, known,
                            static_cast<Eigen::Index>(k) + 1, surrogate, tilt, added);
    if (shares != nullptr) shares->col(k) = added;
    least = {.markov = std::min(least.markov, found.markov),
             .smooth = std::min(least.smooth, found.smooth)};
  };
  run(static_cast<int>(bounds.size()), stage);
}

SurrogateBounds bounds_with_core(const PredictedMotion& motion, const UnsafeSet& unsafe,
                                 const Asked& asked, const PathTilt& tilt, double core,
                                 const Executor& run) {
  const Eigen::Index horizon = motion.policy.horizon();
  SurrogateBounds result{.surrogates = affine_surrogates(motion, core, tilt),
                         .bounds = {},
                         .shares = Eigen::MatrixXd::Ones(region_count(unsafe), horizon)};
  result.bounds.assign(horizon, {.markov = 1.0, .smooth = 1.0});
  lower_bounds(motion, unsafe, asked, tilt, result.surrogates, run, result.bounds, &result.shares);
  return result;
}

/// The stage that tells best whether the narrow core helps: the one with the largest bound below 1,
/// or the first whose bound is 1.
std::size_t telling_stage(const std::vector<RegionProbability>& bounds) {
  const auto says = [](const RegionProbability& bound) {
    return bound.smooth < 1.0 ? bound.smooth : kTryNarrow;
  };
  const auto most =
      std::max_element(bounds.begin(), bounds.end(),
                       [&](const auto& a, const auto& b) { return says(a) < says(b); });
  return static_cast<std::size_t>(most - bounds.begin());
}

/// Lowers the bounds with the narrow core. With kIfTelling this ends at the stage that tells most
/// if the core does not help there and the surrogate of the wide core, `wide`, is mostly unsafe
/// itself: then the motion is near something unsafe rather than poorly known.
void try_narrow_core(const PredictedMotion& motion, const UnsafeSet& unsafe, const Asked& asked,
                     NarrowCore narrow, const std::vector<SurrogateStage>& wide,
                     const Executor& run, std::vector<RegionProbability>& bounds) {
  const std::vector<SurrogateStage> surrogates = affine_surrogates(motion, kNarrowCore);
  Asked left = asked;
  if (narrow == NarrowCore::kIfTelling) {
    const std::size_t stage = telling_stage(bounds);
    const auto index = static_cast<Eigen::Index>(stage);
    const double worthwhile = asked.worthwhile[index];
    const double before = bounds[stage].smooth;
    Asked first = asked;
    first.worthwhile.setConstant(kInfinity);
    first.worthwhile[index] = worthwhile;
    lower_bounds(motion, unsafe, first, {}, surrogates, run_in_turn, bounds, nullptr);
    if (bounds[stage].smooth > kNarrowHelps * before) {
      const double unsafe_itself =
          surrogate_law_bound(unsafe, index + 1, wide[stage + 1], worthwhile);
      if (unsafe_itself > kMostlyUnsafe * before) return;
    }
    left.worthwhile[index] = kInfinity;
  }
  lower_bounds(motion, unsafe, left, {}, surrogates, run, bounds, nullptr);
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
                                 CertificateEffort effort, const Executor& run, NarrowCore narrow) {
  const bool least = effort == CertificateEffort::kLeast;
  const Eigen::VectorXd worthwhile =
      Eigen::VectorXd::Constant(motion.policy.horizon(), least ? kWorthwhile : kNegligibleBound);
  const Asked asked{.worthwhile = worthwhile,
                    .wanted = least ? WantedBounds::kLeast : WantedBounds::kBoth};
  SurrogateBounds result = bounds_with_core(motion, unsafe, asked, {}, kWideCore, run);
  double largest = 0.0;
  for (const RegionProbability& bounds : result.bounds) {
    largest = std::max(largest, bounds.smooth);
  }
  // Without a core in use the narrow one changes nothing.
  const bool in_use = result.surrogates.back().leaving > 0.0;
  if (largest >= kTryNarrow && in_use) {
    try_narrow_core(motion, unsafe, asked, narrow, result.surrogates, run, result.bounds);
  }
  return result;
}

}  // namespace qsmpc::controller
