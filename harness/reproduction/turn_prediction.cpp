#include "harness/reproduction/turn_prediction.hpp"

#include "harness/assembly/assembly.hpp"
#include "harness/mismatch/path_ensemble.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {

PredictionReport on_a_turn(int stages, const std::vector<std::string>& overrides,
                           std::int64_t samples) {
  Scenario scenario = load_scenario("dubins_prediction", overrides);
  scenario.safe_set.body.discs.clear();  // the thesis only has a point
  scenario.controller.horizon = stages;
  PredictionOptions options{.inputs = Eigen::MatrixXd::Constant(1, stages, kTurnRate)};
  options.monte_carlo.samples = samples;
  return predict_scenario(scenario, options);
}

std::vector<controller::Points> samples_of(const PredictionReport& report, const PathChoice& choice,
                                           const controller::Executor& run) {
  const Scenario& scenario = report.scenario;
  const controller::Gaussian belief{.mean = scenario.initial_state.mean,
                                    .covariance = scenario.initial_state.covariance};
  const double share = choice.with_noise ? 1.0 : 0.0;
  const PathSource source(report.policy, belief, share * scenario.disturbance.covariance,
                          {.seed = scenario.seed, .first = choice.first});
  return model_paths(*model_of(scenario), source, choice.count, run);
}

controller::DiscreteMeasure equally_weighted(const controller::Points& points) {
  return {.locations = points,
          .weights =
              Eigen::VectorXd::Constant(points.cols(), 1.0 / static_cast<double>(points.cols()))};
}

}  // namespace qsmpc::harness
