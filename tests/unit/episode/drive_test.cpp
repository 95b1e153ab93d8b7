#include "harness/episode/drive.hpp"

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/assembly/assembly.hpp"
#include "harness/episode/episode.hpp"
#include "harness/errors.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/episode_view.hpp"
#include "harness/trace/trace_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace drive_test {

using ::testing::HasSubstr;

Scenario short_scenario(const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {
      "controller.horizon=4", "controller.quantisation={state: 20, noise: 20, compressed: 20}",
      "limit.steps=6", "plant.kind=analytic"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_scenario("dubins_obstacles", overrides);
}

ControllerObject straight() {
  return {.name = "straight", .act = [](const controller::Situation& now) {
            return ControllerAnswer{.input = -0.5 * now.observation.tail(1)};
          }};
}

TEST(Drive, moved_on_by_its_caller_is_the_episode) {
  const Scenario scenario = short_scenario();
  const Trace episode = run_episode(scenario, {.seed = 3});
  Drive drive(scenario);
  const auto controller = make_controller(scenario, drive.model());
  controller->reset(3);
  drive.begin({.seed = 3});
  while (!drive.outcome()) drive.advance(controller->decide(drive.situation()));
  ASSERT_EQ(drive.trace().steps.size(), episode.steps.size());
  EXPECT_EQ(true_states(drive.trace()), true_states(episode));
  EXPECT_EQ(drive.trace().steps.back().certificates.front().value,
            episode.steps.back().certificates.front().value);
  EXPECT_EQ(*drive.outcome(), episode.outcome);
}

TEST(Drive, is_over_before_it_begins_and_after_its_end) {
  const Scenario scenario = short_scenario({"limit.steps=1"});
  Drive drive(scenario);
  const controller::Decision decision{.input = Eigen::VectorXd::Zero(1)};
  EXPECT_THROW(drive.advance(decision), std::invalid_argument);
  drive.begin({.seed = 1});
  drive.advance(decision);
  EXPECT_EQ(drive.outcome(), Outcome::kTimeout);
  EXPECT_EQ(drive.trace().final_state, drive.state());
  EXPECT_THROW(drive.advance(decision), std::invalid_argument);
}

TEST(Drive, refuses_invalid_inputs) {
  const Scenario scenario = short_scenario();
  Drive drive(scenario);
  drive.begin({.seed = 1});
  EXPECT_THROW(drive.advance({.input = Eigen::VectorXd::Zero(2)}), std::invalid_argument);
  EXPECT_THROW(drive.advance({.input = Eigen::VectorXd::Constant(1, kNotANumber)}),
               std::invalid_argument);
  EXPECT_TRUE(drive.trace().steps.empty());
}

TEST(Drive, certifies_unless_told_not_to) {
  const Scenario scenario = short_scenario();
  Drive drive(scenario);
  const controller::Decision decision{.input = Eigen::VectorXd::Zero(1)};
  drive.begin({.seed = 1});
  EXPECT_EQ(drive.advance(decision).certificates.size(), 1U);
  drive.begin({.seed = 1, .certify = false});
  EXPECT_TRUE(drive.advance(decision).certificates.empty());
}

TEST(ObjectController, drives_and_is_recorded_by_its_name) {
  const Scenario scenario = short_scenario();
  const Trace trace = run_episode(scenario, {.seed = 1}, straight());
  EXPECT_EQ(trace.outcome, Outcome::kTimeout);
  EXPECT_EQ(trace.scenario.controller.kind, "object");
  EXPECT_EQ(trace.steps[2].input[0], -0.5 * trace.steps[2].observation[2]);
  EXPECT_EQ(trace.steps[2].certificates.size(), 1U);
  const qsmpc::testing::TemporaryFolder folder;
  write_trace(folder / "episode.h5", trace);
  EXPECT_EQ(read_trace(folder / "episode.h5").scenario.controller.outside.command,
            std::vector<std::string>{"straight"});
}

TEST(ObjectController, has_its_plans_certified_at_every_stage) {
  const Scenario scenario = short_scenario();
  ControllerObject plans{.name = "plans", .plans = true};
  plans.act = [](const controller::Situation&) {
    ControllerAnswer answer;
    answer.policy.inputs = Eigen::MatrixXd::Constant(1, 4, 0.2);
    return answer;
  };
  const Trace trace = run_episode(scenario, {.seed = 1}, plans);
  EXPECT_EQ(trace.steps.front().certificates.size(), 4U);
  EXPECT_EQ(trace.steps.front().plan_gains.size(), 4U);
  EXPECT_EQ(trace.steps.front().input[0], 0.2);
}

/// The trace of a drive that fails because of `act`.
Trace faulty(const Scenario& scenario,
             std::function<ControllerAnswer(const controller::Situation&)> act) {
  ControllerObject object{.name = "faulty", .act = std::move(act)};
  const Trace trace = run_episode(scenario, {.seed = 1}, std::move(object));
  EXPECT_EQ(trace.outcome, Outcome::kFault);
  EXPECT_EQ(trace.fault_of, FaultOf::kController);
  return trace;
}

TEST(ObjectController, that_throws_is_a_fault_with_its_message) {
  int calls = 0;
  const Trace trace = faulty(short_scenario(), [&](const controller::Situation&) {
    if (++calls > 2) throw std::runtime_error("no idea");
    return ControllerAnswer{.input = Eigen::VectorXd::Zero(1)};
  });
  EXPECT_EQ(trace.steps.size(), 2U);
  EXPECT_THAT(trace.fault, HasSubstr("controller faulty: period 2: found no idea"));
}

TEST(ObjectController, that_lies_or_is_late_is_a_fault) {
  const auto answers = [](Eigen::VectorXd input) {
    return [input](const controller::Situation&) { return ControllerAnswer{.input = input}; };
  };
  EXPECT_THAT(faulty(short_scenario(), answers(Eigen::VectorXd::Constant(1, kNotANumber))).fault,
              HasSubstr("input [nan]"));
  EXPECT_THAT(faulty(short_scenario(), answers(Eigen::VectorXd::Zero(3))).fault,
              HasSubstr("input of 3 numbers"));
  EXPECT_THAT(faulty(short_scenario(), answers(Eigen::VectorXd::Constant(1, 1e3))).fault,
              HasSubstr("out of its bounds"));
  EXPECT_THAT(faulty(short_scenario({"controller.deadline=0.001"}),
                     [](const controller::Situation&) {
                       std::this_thread::sleep_for(std::chrono::milliseconds(20));
                       return ControllerAnswer{.input = Eigen::VectorXd::Zero(1)};
                     })
                  .fault,
              HasSubstr("controller.deadline"));
}

TEST(ObjectController, cannot_be_started_from_a_scenario) {
  EXPECT_THROW((void)short_scenario({"controller.kind=object", "controller.command=[mine]"}),
               InputError);
  const Scenario recorded = with_controller(short_scenario(), straight());
  EXPECT_THROW((void)run_episode(recorded, {}), InputError);
}

}  // namespace drive_test
}  // namespace qsmpc::harness
