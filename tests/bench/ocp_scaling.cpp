// How the time of large problems grows with the number of points, and what further threads gain.
//
//   ocp_scaling [--points N…] [--kept N] [--horizon N] [--threads N] [--repetitions N]
//
// The problem is that of the Dubins car among blocks, closed loop (dubins_blocks.yaml), with N
// points for the belief. Three parts of a control period are timed, each with reused storage as in
// a planner: the prediction with new assignments, where each point's noise is cut into at most a
// hundred parts and N points (or --kept) are kept after every step; cost and gradient at these
// assignments; and cost and gradient without noise. The table gives the median (ms) of each part on
// one thread and on several. Below it are the exponents p of time ~ products^p (without noise
// points^p), by least squares in the logarithms; products are the product points of state and noise
// that the prediction distinguishes, over all stages. Every result on several threads is compared
// bit for bit with the one on one thread; a difference ends the program with 1.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/QR>
#include <fmt/format.h>

#include "controller/planning/cost/horizon_cost.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/planning/policy_maker.hpp"
#include "controller/prediction/prediction.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/threads/executor.hpp"

namespace qsmpc::testing {
namespace {

struct Options {
  std::vector<int> points = {100, 300, 1000, 3000, 10000};
  int horizon = 8;
  int threads = 2;
  int repetitions = 5;
  int kept = 0;  // 0: as many as there are points
};

/// The parts' medians (ms), and the results that must not depend on the number of threads.
struct Measured {
  double predict = 0.0;
  double evaluate = 0.0;
  double without_noise = 0.0;
  double value = 0.0;
  double value_without_noise = 0.0;
  Eigen::VectorXd gradient;
  controller::Points last_stage;
  double parts = 0.0;  // product points with separate weights, over all stages
};

template <class Work>
double median_time(int repetitions, const Work& work) {
  work();  // touches the memory
  std::vector<double> times;
  for (int n = 0; n < repetitions; ++n) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    times.push_back(time.count());
  }
  std::nth_element(times.begin(), times.begin() + repetitions / 2, times.end());
  return times[repetitions / 2];
}

class Problem {
 public:
  Problem(int horizon, int points, int kept)
      : scenario_(harness::load_scenario(QSMPC_SOURCE_DIR
                                         "/tests/bench/scenarios/dubins_blocks.yaml",
                                         {fmt::format("controller.horizon={}", horizon)})),
        model_(harness::model_of(scenario_)),
        settings_(harness::planner_settings(scenario_)),
        belief_{.mean = scenario_.initial_state.mean, .covariance = settings_.noise_covariance},
        start_(controller::quantise(belief_, points)),
        none_(Eigen::MatrixXd::Zero(model_->state_dim(), model_->state_dim())) {
    settings_.state_points = points;
    settings_.compressed_points = kept > 0 ? kept : points;
    controller::PolicyMaker policies(*model_, settings_);
    // Roughly around the first block.
    const Eigen::MatrixXd inputs = Eigen::MatrixXd::Constant(1, horizon, 0.3);
    policies.make(belief_.mean, inputs,
                  Eigen::MatrixXd::Zero(model_->input_dim(), model_->state_dim()), policy_);
  }

  [[nodiscard]] Measured measure(int threads, int repetitions) const {
    const controller::Executor run = harness::executor_of(threads);
    Measured result;
    controller::PredictionScratch scratch;
    controller::Prediction prediction;
    const Eigen::VectorXd z = policy_.inputs.reshaped();
    const Eigen::VectorXd other = 0.99 * z;
    result.gradient.resize(z.size());
    const auto predict_with = [&](controller::Propagator& propagator) {
      controller::predict(*model_, propagator, start_.measure, policy_, run, scratch, prediction);
    };
    // Alternates between two points, so that nothing cached from the last one can be used.
    const auto evaluate_with = [&](controller::HorizonCost& cost) {
      (void)cost.evaluate(other, result.gradient);
      return cost.evaluate(z, result.gradient);
    };
    {
      const auto propagator = controller::make_propagator("noise_free", propagation());
      predict_with(*propagator);
      controller::HorizonCost cost(terms(none_), run);
      cost.freeze_assignments(prediction, policy_);
      result.without_noise =
          0.5 * median_time(repetitions, [&] { result.value_without_noise = evaluate_with(cost); });
    }
    const auto propagator = controller::make_propagator("mixture", propagation());
    result.predict = median_time(repetitions, [&] { predict_with(*propagator); });
    controller::HorizonCost cost(terms(settings_.noise_covariance), run);
    cost.freeze_assignments(prediction, policy_);
    result.evaluate = 0.5 * median_time(repetitions, [&] { result.value = evaluate_with(cost); });
    result.last_stage = prediction.stages.back().locations;
    for (std::size_t k = 0; k < prediction.maps.size(); ++k) {
      result.parts += static_cast<double>(prediction.maps[k].shares.value.size());
    }
    return result;
  }

 private:
  [[nodiscard]] controller::PropagatorSettings propagation() const {
    return {.noise = {.mean = Eigen::VectorXd::Zero(model_->state_dim()),
                      .covariance = settings_.noise_covariance},
            .noise_points = settings_.noise_points,
            .compressed_points = settings_.compressed_points};
  }
  [[nodiscard]] controller::HorizonCostTerms terms(const Eigen::MatrixXd& noise) const {
    return {.dynamics = *model_,
            .safe_set = settings_.safe_set,
            .cost = settings_.cost,
            .penalty = settings_.penalty,
            .noise_covariance = noise,
            .within_covariance = start_.within_covariance};
  }

  harness::Scenario scenario_;
  std::unique_ptr<const models::Dynamics> model_;
  controller::PlannerSettings settings_;
  controller::Gaussian belief_;
  controller::GaussianQuantisation start_;
  Eigen::MatrixXd none_;
  controller::Policy policy_;
};

/// The slope of log(time) over log(size) by least squares.
double exponent(const std::vector<double>& sizes, const std::vector<double>& times) {
  const auto count = static_cast<Eigen::Index>(sizes.size());
  Eigen::MatrixXd a(count, 2);
  Eigen::VectorXd b(count);
  for (Eigen::Index n = 0; n < count; ++n) {
    a.row(n) << 1.0, std::log(sizes[n]);
    b[n] = std::log(times[n]);
  }
  return a.householderQr().solve(b)[1];
}

bool equal(const Measured& a, const Measured& b) {
  return a.value == b.value && a.value_without_noise == b.value_without_noise &&
         a.gradient == b.gradient && a.last_stage == b.last_stage;
}

int run(const Options& options) {
  std::vector<double> products;
  std::vector<double> points_alone;
  std::vector<std::vector<double>> times(3);
  bool all_equal = true;
  fmt::print("Dubins car among blocks, N = {}, {} repetitions; ms on 1 thread / on {} (ratio)\n\n",
             options.horizon, options.repetitions, options.threads);
  fmt::print("| points | products | predict | evaluate | evaluate, no noise | equal |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- |\n");
  for (const int points : options.points) {
    const Problem problem(options.horizon, points, options.kept);
    const Measured one = problem.measure(1, options.repetitions);
    const Measured several = problem.measure(options.threads, options.repetitions);
    const bool same = equal(one, several);
    all_equal = all_equal && same;
    const auto cell = [](double first, double second) {
      return fmt::format("{:.3g} / {:.3g} ({:.2f})", first, second, second / first);
    };
    fmt::print("| {} | {:.0f} | {} | {} | {} | {} |\n", points, one.parts,
               cell(one.predict, several.predict), cell(one.evaluate, several.evaluate),
               cell(one.without_noise, several.without_noise), same ? "yes" : "NO");
    std::fflush(stdout);
    products.push_back(one.parts);
    points_alone.push_back(points);
    times[0].push_back(one.predict);
    times[1].push_back(one.evaluate);
    times[2].push_back(one.without_noise);
  }
  if (options.points.size() > 1) {
    fmt::print("| exponent | | {:.2f} | {:.2f} | {:.2f} | |\n", exponent(products, times[0]),
               exponent(products, times[1]), exponent(points_alone, times[2]));
  }
  return all_equal ? 0 : 1;
}

}  // namespace
}  // namespace qsmpc::testing

int main(int argc, char** argv) {
  qsmpc::testing::Options options;
  CLI::App app("How times grow with the number of points, and what further threads gain");
  app.add_option("--points", options.points, "Points of belief and prediction")
      ->check(CLI::PositiveNumber);
  app.add_option("--horizon", options.horizon, "Stages")->check(CLI::PositiveNumber);
  app.add_option("--kept", options.kept, "Points kept after a step; 0: as many as points")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--threads", options.threads, "Threads to compare with one")
      ->check(CLI::PositiveNumber);
  app.add_option("--repetitions", options.repetitions, "Timed runs of each part")
      ->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  return qsmpc::testing::run(options);
}
