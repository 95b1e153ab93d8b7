// Episodes with every controller and estimator: their traces, and what is derived from them.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "controller/control/controller.hpp"
#include "controller/estimation/estimator.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/episode/episode.hpp"
#include "harness/report/episode_page.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/episode_view.hpp"
#include "harness/trace/trace_file.hpp"
#include "harness/trace/trace_writer.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/trace/trace_matchers.hpp"

namespace qsmpc::harness {
namespace controllers_test {

Scenario scenario_of(const std::vector<std::string>& more) {
  std::vector<std::string> overrides = {
      "controller.horizon=5", "controller.quantisation={state: 20, noise: 20, compressed: 20}",
      "limit.steps=6", "plant.kind=analytic", "vehicle.footprint=point"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_scenario("dubins_obstacles", overrides);
}

/// Every controller; additionally "lqr" about the target, which does not plan.
std::vector<std::vector<std::string>> choices() {
  std::vector<std::vector<std::string>> all;
  for (const controller::ControllerEntry& entry : controller::controllers()) {
    all.push_back({"controller.kind=" + entry.name});
  }
  all.push_back({"controller.kind=lqr", "controller.lqr.about=target"});
  return all;
}

TEST(EpisodeControllers, leave_a_trace_with_what_they_have_that_reads_as_it_was_written) {
  const testing::TemporaryFolder folder;
  for (const std::vector<std::string>& choice : choices()) {
    SCOPED_TRACE(choice.back());
    const Scenario scenario = scenario_of(choice);
    const controller::DecisionParts parts = decision_parts(scenario);
    TraceWriter writer(folder / "episode.h5", trace_header(scenario, 3));
    const Trace trace = run_episode(scenario, {.seed = 3, .writer = &writer});
    ASSERT_EQ(trace.steps.size(), 6U);
    for (const StepRecord& step : trace.steps) {
      EXPECT_EQ(step.plan_inputs.cols(), parts.stages);
      EXPECT_EQ(std::ssize(step.plan_gains), parts.stages);
      EXPECT_EQ(std::ssize(step.particles), parts.particles ? parts.stages + 1 : 0);
      EXPECT_EQ(std::ssize(step.certificates), certified_stages(parts));
      EXPECT_EQ(std::isfinite(step.cost.total()), parts.cost);
      EXPECT_EQ(step.solver_status.empty(), !parts.status);
      EXPECT_LE(step.certificates.front().value, 1.0);
      EXPECT_LT(step.certificates.front().value, 0.5);
    }
    const Trace read = read_trace(folder / "episode.h5");
    ASSERT_EQ(read.steps.size(), trace.steps.size());
    for (std::size_t k = 0; k < read.steps.size(); ++k) {
      testing::expect_same_step(read.steps[k], trace.steps[k]);
    }
  }
}

TEST(EpisodeControllers, have_summaries_and_pages_of_what_they_have) {
  for (const std::vector<std::string>& choice : choices()) {
    SCOPED_TRACE(choice.back());
    const Scenario scenario = scenario_of(choice);
    const Trace trace = run_episode(scenario, {.seed = 3});
    const controller::DecisionParts parts = decision_parts(scenario);
    EXPECT_EQ(EpisodeView(trace).summary().controller, scenario.controller.kind);
    EXPECT_EQ(std::isnan(EpisodeView(trace).summary().horizon_max), parts.stages == 0);
    const std::string page = episode_page(EpisodeView(trace), {});
    const auto mentions = [&](bool wanted, const std::string& text) {
      EXPECT_EQ(page.find(text) != std::string::npos, wanted) << text;
    };
    mentions(true, controller_words(scenario));
    mentions(parts.stages > 0, "Largest plan certificate");
    mentions(parts.cost, "Expected cost of the plan");
    mentions(parts.cost, "<h3>What the plan pays for");
    mentions(parts.status, "Fallbacks");
  }
}

TEST(EpisodeControllers, of_every_kind_drive_with_every_estimator_that_fits) {
  for (const controller::EstimatorEntry& estimator : controller::estimators()) {
    for (const std::vector<std::string>& choice : choices()) {
      SCOPED_TRACE(estimator.name + ", " + choice.back());
      std::vector<std::string> overrides = choice;
      overrides.push_back("estimator.kind=" + estimator.name);
      const char* const noise = estimator.needs_exact_sensor ? "0" : "0.01";
      overrides.push_back(std::string("disturbance.sensor=[") + noise + ", 0, 0]");
      const Scenario scenario = scenario_of(overrides);
      const Trace first = run_episode(scenario, {.seed = 5});
      const Trace second = run_episode(scenario, {.seed = 5});
      ASSERT_EQ(first.steps.size(), 6U);
      EXPECT_EQ(first.final_state, second.final_state);
    }
  }
}

/// The estimate `believed` of a controller with particles is the certificates' unsafe mass of the
/// next stage; others may have their own estimate, and "lqr" has none.
TEST(EpisodeControllers, that_plan_with_particles_believe_in_their_weight) {
  double most = 0.0;
  for (const std::vector<std::string>& choice : choices()) {
    SCOPED_TRACE(choice.back());
    // A wall through the start: part of the belief is unsafe from the beginning.
    std::vector<std::string> more = choice;
    more.insert(more.end(), {"safe_set.bounds={x: [-1, 12], y: [-0.05, 12]}", "risk={}",
                             "limit.stop_when_unsafe=false"});
    const Scenario scenario = scenario_of(more);
    const Trace trace = run_episode(scenario, {.seed = 3});
    ASSERT_EQ(trace.steps.size(), 6U);
    for (const StepRecord& step : trace.steps) {
      if (scenario.controller.kind == "lqr") {
        EXPECT_TRUE(std::isnan(step.believed));
      }
      if (!decision_parts(scenario).particles) {
        EXPECT_FALSE(step.believed < 0.0 || step.believed > 1.0);
        continue;
      }
      // 1e-12: sums of weights in a different order.
      EXPECT_NEAR(step.believed, step.certificates.front().of("unsafe_mass"), 1e-12);
      most = std::max(most, step.believed);
    }
  }
  EXPECT_GT(most, 0.0);
}

/// Without a plan the certificate starts from the observed state and does not include the error of
/// the previous period.
TEST(EpisodeControllers, without_a_plan_are_certified_from_the_observed_state) {
  const Trace trace = run_episode(scenario_of({"controller.kind=lqr", "controller.lqr.about=target",
                                               "model_error={rms: [0.03, 0.04, 0.01]}"}),
                                  {.seed = 7});
  const double radius = Eigen::Vector3d(0.03, 0.04, 0.01).norm();
  for (const StepRecord& step : trace.steps) {
    EXPECT_EQ(step.budgets[0].total, 0.0);
    EXPECT_DOUBLE_EQ(step.budgets[1].model, radius);
  }
}

}  // namespace controllers_test
}  // namespace qsmpc::harness
