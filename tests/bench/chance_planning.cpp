// Planning times of the chance-constrained controllers from the literature, plan after plan with
// warm starts along the path that they drive: median and 99th percentile of a period.
//
//   taskset -c 0 chance_planning [--periods N]
//
// Cases: the Dubins car without obstacles (8 stages, paths without feedback) and among blocks (18),
// and the bicycle among its obstacles. The belief is that of a drive's second period: the noise's
// covariance, about the model's predicted state.
#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "controller/control/controller.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "models/random/random_numbers.hpp"

namespace qsmpc::testing {
namespace {

struct Case {
  std::string name;
  std::string scenario;
  std::vector<std::string> settings;
};

std::vector<Case> cases() {
  const std::string blocks = QSMPC_SOURCE_DIR "/tests/bench/scenarios/dubins_blocks.yaml";
  const std::vector<std::string> free{"controller.horizon=8", "safe_set.obstacles=[]",
                                      "controller.policy=open_loop"};
  std::vector<Case> all;
  for (const int paths : {100, 1000}) {
    std::vector<std::string> settings = free;
    settings.push_back(fmt::format("controller.chance.paths={}", paths));
    settings.emplace_back("controller.kind=scenario");
    all.push_back({fmt::format("scenario, {} paths, 8 stages, free", paths), blocks, settings});
  }
  for (const char* kind : {"cone", "tube", "cantelli", "cvar", "drcc"}) {
    all.push_back({fmt::format("{}, 18 stages, blocks", kind),
                   blocks,
                   {"controller.horizon=18", fmt::format("controller.kind={}", kind)}});
  }
  all.push_back(
      {"scenario, 100 paths, 18 stages, blocks",
       blocks,
       {"controller.horizon=18", "controller.kind=scenario", "controller.chance.paths=100"}});
  for (const char* kind : {"cone", "tube"}) {
    all.push_back({fmt::format("{}, bicycle", kind),
                   "bicycle_obstacles",
                   {fmt::format("controller.kind={}", kind)}});
  }
  return all;
}

/// Times (ms) of every period but the first.
std::vector<double> times_of(const Case& wanted, int periods) {
  const harness::Scenario scenario = harness::load_scenario(wanted.scenario, wanted.settings);
  const auto model = harness::model_of(scenario);
  const auto controller = harness::make_controller(scenario, *model);
  controller->reset(1);
  const models::GaussianSampler noise(Eigen::VectorXd::Zero(model->state_dim()),
                                      scenario.disturbance.covariance);
  controller::Gaussian belief{.mean = scenario.initial_state.mean,
                              .covariance = scenario.disturbance.covariance};
  std::vector<double> times;
  for (int k = 0; k <= periods; ++k) {
    const Eigen::VectorXd seen =
        belief.mean + noise.sample({.seed = 1, .step = static_cast<std::uint64_t>(k)});
    const auto start = std::chrono::steady_clock::now();
    const controller::Decision& decision =
        controller->decide({.period = k, .belief = belief, .observation = seen});
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    if (k > 0) times.push_back(time.count());
    belief.mean = decision.policy->states.col(1);
  }
  std::sort(times.begin(), times.end());
  return times;
}

int run(int argc, char** argv) {
  CLI::App app("times of controllers with chance constraints");
  int periods = 60;
  app.add_option("--periods", periods, "periods per case")->check(CLI::Range(1, 100'000));
  CLI11_PARSE(app, argc, argv);
  fmt::print("{:<42} {:>10} {:>10}\n", "ms", "median", "99 %");
  for (const Case& each : cases()) {
    const std::vector<double> times = times_of(each, periods);
    const auto at = [&](double share) {
      return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
    };
    fmt::print("{:<42} {:>10.3f} {:>10.3f}\n", each.name, at(0.5), at(0.99));
  }
  return 0;
}

}  // namespace
}  // namespace qsmpc::testing

int main(int argc, char** argv) { return qsmpc::testing::run(argc, argv); }
