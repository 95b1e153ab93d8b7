#include "controller/certification/certificate_problem.hpp"

#include <algorithm>

#include "controller/certification/affine_surrogate.hpp"
#include "controller/certification/disc_surrogate.hpp"

namespace qsmpc::controller {
namespace {

// What a region may add without being worked out further …
constexpr double kNegligible = 1e-8;
// … and without a search that takes long.
constexpr double kWorthwhile = 1e-4;
// From where on another core, which alone costs some 1e-2, may help.
constexpr double kTryNarrow = 0.03;

/// C3 and C4 of one stage. C4 takes the better of the two for every part of the unsafe set.
RegionProbability bounds_of_surrogate(const CertificateProblem& problem, Eigen::Index stage,
                                      const SurrogateStage& surrogate) {
  if (surrogate.leaving >= 1.0) return {.markov = 1.0, .smooth = 1.0};
  const bool every = problem.effort() == CertificateEffort::kEvery;
  RegionProbability sum{.markov = surrogate.leaving, .smooth = surrogate.leaving};
  for (const DiscView& disc : problem.unsafe().discs()) {
    const std::function<Eigen::MatrixXd(const std::vector<Eigen::Index>&)> smoothing =
        [&](const std::vector<Eigen::Index>& axes) {
          return disc_smoothing(problem.motion(), stage, axes, disc.placement);
        };
    const DiscSurrogate centre = disc_surrogate(surrogate, disc.placement);
    const SurrogateLaw state{.law = centre.law,
                             .error = centre.error,
                             .higher = centre.higher,
                             .smoothing = smoothing,
                             .worthwhile = every ? kNegligible : kWorthwhile};
    for (const RegionPointer& region : disc.regions) {
      region->add_probability(stage, state, sum);
    }
  }
  return {.markov = std::min(1.0, sum.markov), .smooth = std::min(1.0, sum.smooth)};
}

/// Of all stages. Where they are large, the surrogate with the narrow core is tried, too: it is
/// left more often, and its residuals are smaller.
std::vector<RegionProbability> bounds_of_surrogates(const CertificateProblem& problem) {
  const PredictedMotion& motion = problem.motion();
  std::vector<RegionProbability> least(motion.policy.horizon(), {.markov = 1.0, .smooth = 1.0});
  for (const double core : {kWideCore, kNarrowCore}) {
    const std::vector<SurrogateStage> surrogates = affine_surrogates(motion, core);
    const auto stage = [&](int k) {
      // Neither bound can be less than the probability of leaving, nor C3 less than C4.
      if (least[k].markov <= surrogates[k + 1].leaving) return;
      const RegionProbability bounds =
          bounds_of_surrogate(problem, static_cast<Eigen::Index>(k) + 1, surrogates[k + 1]);
      least[k] = {.markov = std::min(least[k].markov, bounds.markov),
                  .smooth = std::min(least[k].smooth, bounds.smooth)};
    };
    problem.run()(static_cast<int>(least.size()), stage);
    double largest = 0.0;
    for (const RegionProbability& bounds : least) largest = std::max(largest, bounds.smooth);
    // Without a core in use the narrow one changes nothing.
    if (largest < kTryNarrow || surrogates.back().leaving == 0.0) break;
  }
  return least;
}

}  // namespace

CertificateProblem::CertificateProblem(const PredictedMotion& motion, const UnsafeSet& unsafe,
                                       const std::vector<StageBudget>& budgets,
                                       CertificateEffort effort, const Executor& run)
    : motion_(motion),
      unsafe_(unsafe),
      budgets_(budgets),
      effort_(effort),
      run_(run),
      clearances_(motion.policy.horizon()) {
  const auto stage = [&](int k) {
    clearances_[k] = clearances(motion.prediction.stages[k + 1].locations, unsafe, k + 1);
  };
  run(static_cast<int>(clearances_.size()), stage);
}

const std::vector<RegionProbability>& CertificateProblem::surrogate_bounds() const {
  if (!surrogate_bounds_) surrogate_bounds_ = bounds_of_surrogates(*this);
  return *surrogate_bounds_;
}

}  // namespace qsmpc::controller
