// Overhead of an external controller: from the situation to the input, with controllers that answer
// at once.
//
// Requirement: at most 1 ms per period beyond the controller's own time, which is negligible here.
#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "harness/assembly/assembly.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace {

using namespace qsmpc;
using Clock = std::chrono::steady_clock;

constexpr int kPeriods = 5000;
constexpr int kWarm = 100;
constexpr double kPromised = 1.0;  // ms

/// Median and 99th percentile of a period, ms. Returns whether the requirement is met.
bool measure(const char* name, const std::vector<std::string>& overrides) {
  const harness::Scenario scenario = harness::load_scenario("dubins_obstacles", overrides);
  const auto model = harness::model_of(scenario);
  const auto controller = harness::make_controller(scenario, *model);
  const controller::Gaussian belief{.mean = scenario.initial_state.mean,
                                    .covariance = scenario.initial_state.covariance};
  std::vector<double> times;
  for (int k = 0; k < kWarm + kPeriods; ++k) {
    const auto start = Clock::now();
    (void)controller->decide({.period = k, .belief = belief, .observation = belief.mean});
    const std::chrono::duration<double, std::milli> taken = Clock::now() - start;
    if (k >= kWarm) times.push_back(taken.count());
  }
  std::ranges::sort(times);
  const double median = times[times.size() / 2];
  fmt::print("{:<24} median {:.3f} ms, 99 % {:.3f} ms, maximum {:.3f} ms\n", name, median,
             times[times.size() * 99 / 100], times.back());
  return median <= kPromised;
}

}  // namespace

int main() {
  const std::string data = std::string(QSMPC_SOURCE_DIR) + "/tests/data/controllers/";
  const std::string built = std::string(QSMPC_BINARY_DIR) + "/tests/controllers/";
  const std::string constant =
      "controller.command=[python3, -c, \"import sys; sys.stdin.readline(); "
      "print('{\\\"protocol\\\": 1}', flush=True); sys.stdin.readline()\\nfor line in sys.stdin: "
      "print('{\\\"input\\\": [0]}', flush=True)\"]";
  bool kept = measure("program, reads no JSON", {"controller.kind=external", constant});
  kept &= measure("program in Python", {"controller.kind=external",
                                        "controller.command=[python3, " + data + "responder.py]",
                                        "controller.options.mode=good"});
  kept &= measure("C library",
                  {"controller.kind=library", "controller.library=" + built + "library.so"});
  kept &= measure("class in C++",
                  {"controller.kind=library", "controller.library=" + built + "own.so"});
  return kept ? 0 : 1;
}
