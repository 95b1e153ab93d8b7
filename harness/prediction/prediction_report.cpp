#include "harness/prediction/prediction_report.hpp"

#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include "controller/planning/planner.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/assembly/chosen_points.hpp"
#include "harness/assembly/first_decision.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/threads/executor.hpp"
#include "harness/threads/workers.hpp"
#include "harness/version.hpp"

namespace qsmpc::harness {

namespace {

controller::LawSettings law_settings(const Scenario& scenario) {
  const controller::PlannerSettings planner = planner_settings(scenario);
  return {.seed = scenario.seed,
          .quantiser = planner.quantiser,
          .state_points = planner.state_points,
          .noise_points = planner.noise_points,
          .compressed_points = planner.compressed_points};
}

/// Simulates the motion, and compares the methods with its paths.
void simulate_and_compare(const controller::PredictedMotion& motion,
                          const PredictionOptions& options, PredictionReport& report) {
  const Scenario& scenario = report.scenario;
  MonteCarloOptions simulation = options.monte_carlo;
  simulation.seed = scenario.seed;
  if (options.methods.empty()) {
    report.monte_carlo = simulate_unsafe_counts(motion, scenario.safe_set, simulation);
    report.interrupted = !report.monte_carlo;
    return;
  }
  std::optional<SimulatedPaths> paths =
      simulate_paths(motion, scenario.safe_set, simulation, kKeptPaths);
  if (paths) {
    report.monte_carlo = std::move(paths->counts);
    report.laws = compare_laws(motion, scenario.safe_set, std::move(paths->laws),
                               {.methods = options.methods,
                                .settings = law_settings(scenario),
                                .threads = simulation.threads,
                                .should_stop = simulation.should_stop});
  }
  report.interrupted = !report.laws;
}

/// Certifies the motion, and simulates it if requested.
void judge(const controller::PredictedMotion& motion, const PredictionOptions& options,
           PredictionReport& report) {
  const Scenario& scenario = report.scenario;
  report.policy = motion.policy;
  report.prediction = controller::without_shares(motion.prediction);
  report.budgets = controller::error_budget(motion);
  // All bounds are reported, so each is made as tight as possible.
  report.certificates = controller::certify(
      motion, scenario.safe_set, report.budgets, controller::CertificateEffort::kTightest,
      executor_of(usable_threads(options.monte_carlo.threads)));
  report.horizon_bound = controller::horizon_bound(report.certificates);
  if (options.monte_carlo.samples > 0) simulate_and_compare(motion, options, report);
}

}  // namespace

PredictionReport predict_scenario(const Scenario& asked, const PredictionOptions& options) {
  if (!options.methods.empty() && options.monte_carlo.samples < kKeptPaths) {
    throw std::invalid_argument("prediction: too few simulated paths to compare methods");
  }
  for (const std::string& name : options.methods) (void)controller::law_method(name);
  const Scenario scenario = with_chosen_points(asked);
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
    // Negated so that a NaN certificate counts as contradicted.
    if (!(report.certificates[k].value >= simulated.limits.lower)) {
      stages.push_back(static_cast<int>(k) + 1);
    }
  }
  return stages;
}

}  // namespace qsmpc::harness
