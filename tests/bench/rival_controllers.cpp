// Time per period of the sampling controllers: from the situation to the decision, without
// certificates, on one thread.
//
//   rival_controllers [--periods N] [--at-most MS]
//
// Each drives shipped scenarios on the model without noise, horizon 18: `mppi` with 1,024 samples,
// `risk_mppi` with its default settings, and, for comparison, `nominal` and `quantised`. Prints
// median and 99th percentile of a period. Exits with 1 if a median of `mppi` is above --at-most (4
// ms). For meaningful figures, pin it to one core: taskset -c 1 rival_controllers.
#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/assembly/assembly.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace {

using namespace qsmpc;
using Clock = std::chrono::steady_clock;

constexpr int kWarm = 5;

struct Options {
  int periods = 40;
  double at_most = 4.0;  // ms
};

/// Time of each period, ms.
std::vector<double> times_of(const std::string& scenario_name, const std::string& kind,
                             int periods) {
  const harness::Scenario scenario =
      harness::load_scenario(scenario_name, {"controller.kind=" + kind, "controller.horizon=18"});
  const auto model = harness::model_of(scenario);
  const auto controller = harness::make_controller(scenario, *model);
  controller::Gaussian belief{.mean = scenario.initial_state.mean,
                              .covariance = scenario.initial_state.covariance};
  models::StateBatch state = belief.mean;
  models::StateBatch next = state;
  std::vector<double> times;
  for (int k = 0; k < kWarm + periods; ++k) {
    const auto start = Clock::now();
    const controller::Decision& decision =
        controller->decide({.period = k, .belief = belief, .observation = belief.mean});
    const std::chrono::duration<double, std::milli> taken = Clock::now() - start;
    if (k >= kWarm) times.push_back(taken.count());
    model->step(state, models::StateBatch(decision.input), next);
    state = next;
    belief.mean = state.col(0);
  }
  std::ranges::sort(times);
  return times;
}

bool report(const Options& options) {
  bool kept = true;
  for (const std::string scenario : {"dubins_obstacles", "bicycle_obstacles"}) {
    for (const std::string kind : {"mppi", "risk_mppi", "nominal", "quantised"}) {
      const std::vector<double> times = times_of(scenario, kind, options.periods);
      const double median = times[times.size() / 2];
      fmt::print("{:<18} {:<10} median {:7.3f} ms, 99 % {:7.3f} ms\n", scenario, kind, median,
                 times[times.size() * 99 / 100]);
      kept = kept && (kind != "mppi" || median <= options.at_most);
    }
  }
  return kept;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Time per period of the sampling controllers");
  app.add_option("--periods", options.periods, "Periods to time")->check(CLI::PositiveNumber);
  app.add_option("--at-most", options.at_most, "Limit on the medians of mppi, ms");
  CLI11_PARSE(app, argc, argv);
  return report(options) ? 0 : 1;
}
