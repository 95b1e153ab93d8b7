// How close plans come to the best policies.
//
//   planning_quality [--paths N] [--starts N] [--horizon N…] [--inputs]
//                    [--points N] [--propagator NAME] [--evaluations N]
//
// In open loop without obstacles, plans and optima are evaluated exactly (dubins_closed_form.hpp):
// a plan may cost 0.1 more than the optimum at 8 stages and 0.5 at 18. In closed loop among the
// blocks of dubins_obstacles, they are evaluated on 20,000 simulated paths; the best policy is the
// best result of descents on N paths (default 2,000) from the plan, constant inputs and N random
// starts (default 8), and a plan may cost 0.2 % more. The last three options are the planner's.
// --inputs: prints both input sequences. "pred. best" is how much more the planner predicts for the
// best policy than for its own: above 0 the prediction misleads, below 0 the solver stopped too
// early or in another local minimum. Exits with 1 if a plan costs more than allowed.
#include "tests/support/planning_quality.hpp"

#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace qsmpc::testing {
namespace {

constexpr double kRelative = 0.002;

struct Options {
  int paths = 2000;
  int starts = 8;
  int points = 100;
  int evaluations = 100;
  std::string propagator = "mixture";
  std::vector<int> horizons = {8, 12, 18};
  bool inputs = false;
};

double allowed(int horizon) { return horizon <= 8 ? 0.1 : 0.5; }

controller::PlannerSettings with(const Options& options, controller::PlannerSettings settings) {
  settings.state_points = options.points;
  settings.noise_points = options.points;
  settings.compressed_points = options.points;
  settings.max_evaluations = options.evaluations;
  settings.propagator = options.propagator;
  return settings;
}

void print_inputs(const char* name, const Eigen::MatrixXd& inputs) {
  std::cout << fmt::format("    {:8} {:.3f}\n", name,
                           fmt::join(inputs.data(), inputs.data() + inputs.size(), " "));
}

/// Prints one row; returns whether the plan is good enough.
bool print(const std::string& name, int horizon, const Shortfall& shortfall, double limit,
           const Options& options) {
  const bool good = shortfall.absolute() <= limit;
  std::cout << fmt::format(
      "{:33} {:3} {:11.2f} {:11.2f} {:10.4f} {:8.4f} {:9.4f} {:11.2f} {:+12.2f} {:5}  {}{}\n", name,
      horizon, shortfall.planned, shortfall.best, shortfall.absolute(),
      100.0 * shortfall.relative(), limit, shortfall.predicted,
      shortfall.predicted_best - shortfall.predicted, shortfall.plan.evaluations,
      controller::solver_status_name(shortfall.plan.status),
      good ? "" : ", costs more than allowed");
  if (options.inputs) {
    print_inputs("planned", shortfall.plan.policy.inputs);
    print_inputs("best", shortfall.best_inputs);
  }
  return good;
}

void print_header(const std::string& title) {
  std::cout << fmt::format(
      "\n{}\n{:33} {:>3} {:>11} {:>11} {:>10} {:>8} {:>9} {:>11} {:>12} {:>5}\n", title, "place",
      "N", "planned", "best", "more", "more %", "allowed", "predicted", "pred. best", "eval");
}

bool report_open_loop(const Options& options) {
  print_header("Open loop without obstacles, evaluated exactly");
  bool good = true;
  for (const int horizon : options.horizons) {
    const controller::PlannerSettings settings =
        with(options, free_settings(horizon, /*closed_loop=*/false));
    for (const double heading : {0.7, -1.5, 3.0}) {
      const controller::Gaussian belief = first_belief(0.0, 0.0, heading);
      good = print(fmt::format("start, heading {}", heading), horizon,
                   exact_shortfall(settings, belief), allowed(horizon), options) &&
             good;
    }
    for (const Place& place : places_among_blocks()) {
      good = print(place.name, horizon, exact_shortfall(settings, place.belief), allowed(horizon),
                   options) &&
             good;
    }
  }
  return good;
}

bool report_closed_loop(const Options& options) {
  print_header("Closed loop among blocks, evaluated on simulated paths");
  const std::unique_ptr<const models::Dynamics> car = default_car();
  const SamplingSettings sampling{
      .search = {.draws = {.paths = options.paths, .seed = 1}, .random_starts = options.starts}};
  bool good = true;
  for (const int horizon : options.horizons) {
    const controller::PlannerSettings settings = with(options, blocks_settings(horizon));
    for (const Place& place : places_among_blocks()) {
      const Shortfall shortfall = sampled_shortfall(*car, settings, place.belief, sampling);
      good = print(place.name, horizon, shortfall, kRelative * shortfall.best, options) && good;
    }
  }
  return good;
}

}  // namespace
}  // namespace qsmpc::testing

int main(int argc, char** argv) {
  qsmpc::testing::Options options;
  CLI::App app("Costs of plans compared with the best policies");
  app.add_option("--paths", options.paths, "Paths used by the search")->check(CLI::PositiveNumber);
  app.add_option("--starts", options.starts, "Random starts of the search")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--points", options.points, "Points of belief, noise and prediction")
      ->check(CLI::PositiveNumber);
  app.add_option("--evaluations", options.evaluations, "Evaluations of the cost in one plan")
      ->check(CLI::PositiveNumber);
  app.add_option("--propagator", options.propagator, "Propagator for the prediction");
  app.add_option("--horizon", options.horizons, "Horizons")->check(CLI::PositiveNumber);
  app.add_flag("--inputs", options.inputs, "Print the inputs");
  CLI11_PARSE(app, argc, argv);
  try {
    const bool open_loop = qsmpc::testing::report_open_loop(options);
    const bool closed_loop = qsmpc::testing::report_closed_loop(options);
    return open_loop && closed_loop ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
