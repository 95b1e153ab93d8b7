// Drives by external controllers: their results, and the handling of controllers that fail.
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/assembly/assembly.hpp"
#include "harness/assembly/first_decision.hpp"
#include "harness/episode/episode.hpp"
#include "harness/errors.hpp"
#include "harness/report/episode_page.hpp"
#include "harness/trace/episode_view.hpp"
#include "harness/trace/trace_file.hpp"
#include "harness/trace/trace_writer.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/control/outside_fixture.hpp"
#include "tests/unit/trace/trace_matchers.hpp"

namespace qsmpc::harness {
namespace outside_drives_test {

using ::testing::HasSubstr;

constexpr OutsideKind kKinds[] = {OutsideKind::kExternal, OutsideKind::kLibrary,
                                  OutsideKind::kOwnClass};

class OutsideControllers : public ::testing::TestWithParam<OutsideKind> {};

TEST_P(OutsideControllers, drive_and_are_certified_from_the_observed_state) {
  const Scenario scenario = outside_scenario(GetParam());
  const Trace trace = run_episode(scenario, {.seed = 3});
  EXPECT_EQ(trace.outcome, Outcome::kTimeout) << trace.fault;
  ASSERT_EQ(trace.steps.size(), 6U);
  for (const StepRecord& step : trace.steps) {
    EXPECT_DOUBLE_EQ(step.input[0], 0.03);  // of the seed
    EXPECT_EQ(step.plan_inputs.size(), 0);
    ASSERT_EQ(step.certificates.size(), 1U);
    EXPECT_LT(step.certificates.front().value, 0.5);
    EXPECT_EQ(step.budgets[0].total, 0.0);
    EXPECT_GT(step.timing.optimise, 0.0);
  }
}

TEST_P(OutsideControllers, drive_every_seed_of_a_driver_as_a_driver_of_its_own_would) {
  const Scenario scenario = outside_scenario(GetParam());
  EpisodeDriver driver(scenario);
  for (const std::uint64_t seed : {4U, 5U}) {
    const Trace shared = driver.run({.seed = seed});
    EXPECT_EQ(shared.final_state, run_episode(scenario, {.seed = seed}).final_state);
  }
}

TEST_P(OutsideControllers, that_fail_end_the_drive_with_a_reason_and_the_trace_so_far) {
  struct Failure {
    std::string mode;
    std::string reason;
  };
  const std::vector<Failure> failures = {{"crash", "signal 11 (Segmentation fault)"},
                                         {"exit", "an exit with code 7"},
                                         {"hang", "no answer within 3 s"},
                                         {"nan", "input"},
                                         {"inf", "input"},
                                         {"size", "2 numbers"},
                                         {"bounds", "yaw_rate = 99, out of its bounds"},
                                         {"error", "no way out"}};
  for (const Failure& failure : failures) {
    SCOPED_TRACE(failure.mode);
    const testing::TemporaryFolder folder;
    const Scenario scenario = failing_scenario(GetParam(), failure.mode);
    TraceWriter writer(folder / "episode.h5", trace_header(scenario, 3));
    const Trace trace = run_episode(scenario, {.seed = 3, .writer = &writer});
    EXPECT_EQ(trace.outcome, Outcome::kFault);
    EXPECT_EQ(trace.fault_of, FaultOf::kController);
    EXPECT_THAT(trace.fault, HasSubstr("period 2: found "));
    EXPECT_THAT(trace.fault, HasSubstr(failure.reason));
    ASSERT_EQ(trace.steps.size(), 2U);
    // The plant completed all of them.
    EXPECT_EQ(completed_periods(trace), 2);
    EXPECT_EQ(EpisodeView(trace).summary().fault_of, "controller");
    const Trace read = read_trace(folder / "episode.h5");
    EXPECT_EQ(read.fault_of, FaultOf::kController);
    EXPECT_EQ(read.fault, trace.fault);
    EXPECT_EQ(read.final_state, trace.final_state);
    EXPECT_EQ(read.steps.size(), 2U);
  }
}

TEST_P(OutsideControllers, that_failed_drive_again) {
  const Scenario scenario = failing_scenario(GetParam(), "crash");
  EpisodeDriver driver(scenario);
  for (int n = 0; n < 2; ++n) EXPECT_EQ(driver.run({.seed = 1}).steps.size(), 2U);
}

INSTANTIATE_TEST_SUITE_P(all, OutsideControllers, ::testing::ValuesIn(kKinds),
                         [](const auto& kind) {
                           return kind.param == OutsideKind::kExternal  ? "external"
                                  : kind.param == OutsideKind::kLibrary ? "library"
                                                                        : "own_class";
                         });

TEST(OutsideLibrary, finds_nothing_to_read_in_its_standard_input) {
  const Trace trace = run_episode(failing_scenario(OutsideKind::kLibrary, "reads"), {.seed = 3});
  EXPECT_EQ(trace.outcome, Outcome::kTimeout) << trace.fault;
  EXPECT_EQ(trace.steps.size(), 6U);
}

/// With plans: an external controller and a C++ class that give the same answers.
TEST(OutsidePlans, are_certified_stage_by_stage_and_leave_traces_and_pages) {
  const testing::TemporaryFolder folder;
  std::vector<Trace> traces;
  for (const OutsideKind kind : {OutsideKind::kExternal, OutsideKind::kOwnClass}) {
    const Scenario scenario = outside_scenario(kind, {"controller.plans=true"});
    ASSERT_EQ(decision_parts(scenario).stages, 5);
    TraceWriter writer(folder / "episode.h5", trace_header(scenario, 3));
    traces.push_back(run_episode(scenario, {.seed = 3, .writer = &writer}));
    const Trace& trace = traces.back();
    ASSERT_EQ(trace.steps.size(), 6U) << trace.fault;
    const Trace read = read_trace(folder / "episode.h5");
    for (std::size_t k = 0; k < trace.steps.size(); ++k) {
      const StepRecord& step = trace.steps[k];
      testing::expect_same_step(read.steps[k], step);
      EXPECT_EQ(step.certificates.size(), 5U);
      EXPECT_EQ(step.plan_states.col(0), step.belief_mean);
      // The plan's first stage at the observed state.
      const double input =
          0.1 + Eigen::RowVector3d(0.0, -0.5, -1.0).dot(step.observation - step.belief_mean);
      EXPECT_NEAR(step.input[0], input, 1e-15);
      EXPECT_EQ(step.solver_status, "stalled");
      EXPECT_EQ(step.iterations, 3);
      EXPECT_GT(step.cost.total(), 0.0);
    }
    EXPECT_THAT(episode_page(EpisodeView(trace), {}), HasSubstr(controller_words(scenario)));
  }
  EXPECT_EQ(traces[0].final_state, traces[1].final_state);
  EXPECT_EQ(traces[0].steps[3].certificates[4].value, traces[1].steps[3].certificates[4].value);
}

// Two inputs, so that stages, inputs and states cannot be taken for each other.
TEST(OutsidePlans, of_libraries_are_read_stage_by_stage) {
  std::vector<std::string> overrides = controller_overrides(OutsideKind::kLibrary);
  overrides.insert(overrides.end(), {"controller.plans=true", "controller.horizon=3", "risk={}",
                                     "limit.steps=1", "plant.kind=analytic"});
  const Trace trace = run_episode(load_scenario("bicycle_obstacles", overrides), {.seed = 3});
  ASSERT_EQ(trace.steps.size(), 1U) << trace.fault;
  const StepRecord& step = trace.steps[0];
  ASSERT_EQ(step.plan_inputs.cols(), 3);
  ASSERT_EQ(step.plan_gains.size(), 3U);
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 2; ++i) {
      EXPECT_DOUBLE_EQ(step.plan_inputs(i, k), 1e-3 * (2 * k + i));
      for (int j = 0; j < 6; ++j) {
        EXPECT_DOUBLE_EQ(step.plan_gains[static_cast<std::size_t>(k)](i, j),
                         1e-4 * ((2 * k + i) * 6 + j));
      }
    }
  }
}

TEST(OutsidePlans, are_predicted_as_those_of_the_program_are) {
  const Scenario scenario = outside_scenario(OutsideKind::kExternal, {"controller.plans=true"});
  const auto model = model_of(scenario);
  const FirstDecision first(scenario, *model);
  EXPECT_EQ(first.motion().policy.horizon(), 5);
  const Scenario failing =
      outside_scenario(OutsideKind::kExternal, {"controller.options.mode=old"});
  EXPECT_THROW(FirstDecision(failing, *model), ControllerError);
}

}  // namespace outside_drives_test
}  // namespace qsmpc::harness
