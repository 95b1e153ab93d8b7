// Every shipped scenario on every plant of its system, for a few periods; and how often episodes of
// the reference thesis's experiments succeed.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/episode/episode.hpp"
#include "harness/scenario/plant_choice.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/shipped_files.hpp"
#include "harness/trace/episode_view.hpp"
#include "tests/support/effort.hpp"

namespace qsmpc::harness {
namespace shipped_scenarios_test {

using namespace testing;

/// The plants of `system`: the model, and each shipped MuJoCo plant.
std::vector<std::string> plants_of(const std::string& system) {
  std::vector<std::string> names = {"analytic"};
  for (const ShippedPlant& plant : shipped_plants()) {
    if (plant.system == system) names.push_back(plant.name);
  }
  return names;
}

class ShippedScenarios : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedScenarios, run_on_every_plant_of_their_system_with_a_certificate_each_period) {
  constexpr std::size_t kSteps = 3;
  const Scenario scenario = load_scenario(GetParam(), {"limit.steps=3"});
  std::vector<std::string> plants = plants_of(scenario.model.system);
  if (scenario.plant.kind == "mujoco") plants.emplace_back("mujoco");
  EXPECT_GE(plants.size(), 2U);
  for (const std::string& plant : plants) {
    SCOPED_TRACE(plant);
    const Trace trace = run_episode(with_plant(scenario, plant), {.seed = 0});
    EXPECT_EQ(trace.outcome, Outcome::kTimeout) << outcome_name(trace.outcome) << trace.fault;
    ASSERT_EQ(trace.steps.size(), kSteps);
    for (const StepRecord& step : trace.steps) {
      EXPECT_FALSE(step.fallback);
      ASSERT_FALSE(step.certificates.empty());
      // None of them reaches its obstacles this early.
      EXPECT_LE(step.certificates.front().value, 0.1);
      EXPECT_EQ(step.certificates.size(), static_cast<std::size_t>(scenario.controller.horizon));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScenarios, ::testing::ValuesIn(shipped_scenario_names()),
                         [](const auto& tested) { return tested.param; });

/// A row of the thesis's tables, or its equivalent on another plant.
struct Experiment {
  std::string name;
  std::string scenario;
  std::vector<std::string> overrides{};
  std::string plant = "analytic";
  bool expensive = false;  ///< one seed, except with --slow
};

void PrintTo(const Experiment& experiment, std::ostream* out) { *out << experiment.name; }

const std::string kOpenLoop = "controller.policy=open_loop";
const std::string kNoiseUnknown = "controller.propagate_noise=false";
const std::string kSlsqp = "controller.solver=slsqp";

const std::vector<Experiment>& experiments() {
  static const std::vector<Experiment> all = {
      {"turn", "dubins_turn"},
      {"turn_open_loop", "dubins_turn", {kOpenLoop}},
      {"turn_noise_unknown", "dubins_turn", {kNoiseUnknown}},
      {"turn_noise_unknown_open_loop", "dubins_turn", {kNoiseUnknown, kOpenLoop}},
      {"turn_car", "dubins_turn", {}, "mujoco_car"},
      {"trap", "dubins_trap"},
      {"trap_490", "dubins_trap", {"controller.quantisation.state=490"}, "analytic", true},
      {"trap_1000", "dubins_trap", {"controller.quantisation.state=1000"}, "analytic", true},
      {"trap_slsqp", "dubins_trap", {kSlsqp, "controller.horizon=15"}},
      {"trap_slsqp_490",
       "dubins_trap",
       {kSlsqp, "controller.horizon=15", "controller.quantisation.state=490"},
       "analytic",
       true},
      {"trap_slsqp_1000",
       "dubins_trap",
       {kSlsqp, "controller.horizon=15", "controller.quantisation.state=1000"},
       "analytic",
       true},
      {"square", "bicycle_square"},
      {"square_486", "bicycle_square", {"controller.quantisation.state=486"}, "analytic", true},
      {"square_972", "bicycle_square", {"controller.quantisation.state=972"}, "analytic", true},
      {"square_noise_known", "bicycle_square", {"controller.propagate_noise=true"}},
      {"prediction", "dubins_prediction"},
      {"swing_up", "cart_pole", {}, "analytic", true},
      {"swing_up_mujoco", "cart_pole", {}, "mujoco_cart_pole", true},
      {"balance", "cart_pole_balance", {}, "analytic", true},
      {"double_integrator", "double_integrator"}};
  return all;
}

class ThesisExperiments : public ::testing::TestWithParam<Experiment> {};

// The requirement is nine of ten seeds. Among the few driven by default one may fail; a controller
// that does not work fails on nearly all of them.
TEST_P(ThesisExperiments, reach_the_target_without_entering_the_unsafe_set) {
  const Experiment& experiment = GetParam();
  const Scenario scenario =

      with_plant(load_scenario(experiment.scenario, experiment.overrides), experiment.plant);
  const int seeds = experiment.expensive ? by_effort(1, 1, 50) : by_effort(2, 3, 50);
  const int promised = seeds == 50 ? 45 : std::max(1, seeds - 1);
  int reached = 0;
  std::string others;
  for (int seed = 0; seed < seeds; ++seed) {
    const Summary summary =
        EpisodeView(run_episode(scenario, {.seed = static_cast<std::uint64_t>(seed)})).summary();
    const bool well = summary.outcome == outcome_name(Outcome::kReached) && !summary.collision;
    if (well) ++reached;
    if (!well) others += ' ' + std::to_string(seed) + ' ' + summary.outcome;
  }
  RecordProperty("reached", reached);
  EXPECT_GE(reached, promised) << "of " << seeds << "; not:" << others;
}

INSTANTIATE_TEST_SUITE_P(All, ThesisExperiments, ::testing::ValuesIn(experiments()),
                         [](const auto& tested) { return tested.param.name; });

TEST(TrackLap, is_driven_on_the_road_and_within_its_limit_whatever_the_seed) {
  const Scenario scenario = load_scenario("track_lap");
  const int seeds = by_effort(1, 2, 50);
  for (int seed = 0; seed < seeds; ++seed) {
    const Trace trace = run_episode(scenario, {.seed = static_cast<std::uint64_t>(seed)});
    const EpisodeView view(trace);
    const Summary& summary = view.summary();
    EXPECT_EQ(summary.outcome, outcome_name(Outcome::kReached)) << seed;
    EXPECT_FALSE(summary.unsafe_between.value_or(true)) << seed;
    ASSERT_TRUE(summary.laps.has_value());
    EXPECT_EQ(summary.laps->times.size(), 1U) << seed;
    EXPECT_EQ(summary.risk.plan.exceeded, 0) << seed;
  }
}

// The limit covers the car's difference from its model, measured on other drives than these.
TEST(CertifiedCar, keeps_the_limit_that_includes_its_model_error) {
  const Scenario scenario = load_scenario("certified_car");
  ASSERT_TRUE(scenario.model_error.has_value());
  const int seeds = by_effort(1, 2, 50);
  for (int seed = 0; seed < seeds; ++seed) {
    const Trace trace = run_episode(scenario, {.seed = static_cast<std::uint64_t>(seed)});
    const EpisodeView view(trace);
    const Summary& summary = view.summary();
    EXPECT_EQ(summary.outcome, outcome_name(Outcome::kReached)) << seed;
    EXPECT_FALSE(summary.collision) << seed;
    EXPECT_EQ(summary.risk.plan.exceeded, 0) << seed;
    // A Dubins car would be off by up to 0.1 rad.
    for (const StepRecord& step : trace.steps) {
      EXPECT_LT(std::abs(step.residual[2]), 0.01) << seed;
    }
  }
}

}  // namespace shipped_scenarios_test
}  // namespace qsmpc::harness
