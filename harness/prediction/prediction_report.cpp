#include "harness/prediction/prediction_report.hpp"

#include <limits>
#include <memory>

#include "controller/planning/planner.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/assembly/first_decision.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/version.hpp"

namespace qsmpc::harness {

namespace {

/// Certifies the motion, and simulates it where that is wanted.
void judge(const controller::PredictedMotion& motion, const PredictionOptions& options,
           PredictionReport& report) {
  const Scenario& scenario = report.scenario;
  report.policy = motion.policy;
  report.prediction = motion.prediction;
  report.budgets = controller::error_budget(motion);
  // All bounds are reported, so each is to be as good as it gets.
  report.certificates = controller::certify(motion, scenario.safe_set, report.budgets,
                                            controller::CertificateEffort::kEvery);
  report.horizon_bound = controller::horizon_bound(report.certificates);
  if (options.monte_carlo.samples > 0) {
    MonteCarloOptions simulation = options.monte_carlo;
    simulation.seed = scenario.seed;
    report.monte_carlo = simulate_unsafe_counts(motion, scenario.safe_set, simulation);
    report.interrupted = !report.monte_carlo;
  }
}

}  // namespace

PredictionReport predict_scenario(const Scenario& scenario, const PredictionOptions& options) {
  const std::unique_ptr<const models::Dynamics> model = model_of(scenario);
  PredictionReport report;
  report.scenario = scenario;
  report.system = model->description();
  report.scenario_text = to_yaml(scenario);
  report.version = kVersion;
  report.inputs_given = options.inputs.has_value();
  if (report.inputs_given) {
    controller::Planner planner(*model, planner_settings(scenario));
    const controller::Gaussian belief{.mean = scenario.initial_state.mean,
                                      .covariance = scenario.initial_state.covariance};
    const controller::Plan& plan = planner.prescribe(belief, *options.inputs);
    report.cost = plan.cost;
    judge(of_plant(controller::motion_of(planner, belief, plan), scenario, 0), options, report);
    return report;
  }
  const FirstDecision first(scenario, *model);
  const controller::Decision& decision = first.decision();
  report.cost =
      decision.cost.value_or(controller::CostParts::all(std::numeric_limits<double>::quiet_NaN()));
  if (decision.status) report.solver_status = controller::solver_status_name(*decision.status);
  judge(of_plant(first.motion(), scenario, 0), options, report);
  return report;
}

SimulatedRate simulated_rate(std::int64_t events, std::int64_t samples) {
  return {.rate = static_cast<double>(events) / static_cast<double>(samples),
          .limits = clopper_pearson(events, samples, kRateTail)};
}

std::vector<int> contradicted_stages(const PredictionReport& report) {
  std::vector<int> stages;
  if (!report.monte_carlo) return stages;
  const UnsafeCounts& counts = *report.monte_carlo;
  for (std::size_t k = 0; k < report.certificates.size(); ++k) {
    const SimulatedRate simulated = simulated_rate(counts.stages[k], counts.samples);
    // Written so that a certificate that is not a number is one that does not hold.
    if (!(report.certificates[k].value >= simulated.limits.lower)) {
      stages.push_back(static_cast<int>(k) + 1);
    }
  }
  return stages;
}

}  // namespace qsmpc::harness
