#include "harness/reproduction/plans_at_beliefs.hpp"

#include <cstddef>
#include <memory>
#include <optional>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "controller/planning/planner.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/prediction/monte_carlo.hpp"
#include "harness/statistics/sample_statistics.hpp"

namespace qsmpc::harness {
namespace {

constexpr Eigen::Index kBeliefPeriod = 10;  // periods from one belief to the next

/// The model's prediction from period `k` of `drive`.
controller::Gaussian belief_after(const EpisodeDigest& drive, Eigen::Index k,
                                  const models::Dynamics& model,
                                  const Eigen::MatrixXd& noise_covariance) {
  models::StateBatch next(model.state_dim(), 1);
  model.step(models::StateBatch(drive.states.col(k)), models::StateBatch(drive.inputs.col(k)),
             next);
  return {.mean = next.col(0), .covariance = noise_covariance};
}

/// How often paths of the model under the plan are unsafe at one of its stages.
double simulated_risk(const controller::PredictedMotion& motion,
                      const controller::SafeSet& safe_set, std::uint64_t seed,
                      Eigen::Index period) {
  // A distinct seed for every plan: drives are shorter than this many periods.
  constexpr std::uint64_t kMostPeriods = 1'000'000;
  const MonteCarloOptions options{.seed = seed * kMostPeriods + static_cast<std::uint64_t>(period),
                                  .samples = kPathsAPlan,
                                  .threads = 1};
  const std::optional<UnsafeCounts> counts = simulate_unsafe_counts(motion, safe_set, options);
  return static_cast<double>(counts->any_stage) / static_cast<double>(kPathsAPlan);
}

}  // namespace

PlanRisk plan_risk_at_beliefs(const Sample& drives, const Scenario& scenario,
                              const controller::Executor& run) {
  const std::unique_ptr<const models::Dynamics> model = model_of(scenario);
  const std::size_t count = drives.episodes.size();
  PlanRisk means{.certified = std::vector<double>(count), .simulated = std::vector<double>(count)};
  run(static_cast<int>(count), [&](int n) {
    const EpisodeDigest& drive = drives.episodes[static_cast<std::size_t>(n)];
    controller::Planner planner(*model, planner_settings(scenario));
    std::vector<double> certified;
    std::vector<double> simulated;
    for (Eigen::Index k = 0; k < drive.inputs.cols(); k += kBeliefPeriod) {
      const controller::Gaussian belief =
          belief_after(drive, k, *model, scenario.disturbance.covariance);
      planner.reset();
      const controller::PredictedMotion motion =
          controller::motion_of(planner, belief, planner.plan(belief));
      certified.push_back(controller::horizon_bound(
          controller::certify(motion, scenario.safe_set, controller::error_budget(motion))));
      simulated.push_back(simulated_risk(motion, scenario.safe_set, drive.seed, k));
    }
    means.certified[static_cast<std::size_t>(n)] = mean_of(certified);
    means.simulated[static_cast<std::size_t>(n)] = mean_of(simulated);
  });
  return means;
}

}  // namespace qsmpc::harness
