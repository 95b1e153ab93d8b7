// Drives over waypoints.
#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "harness/episode/episode.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/episode_view.hpp"
#include "harness/trace/target_progress.hpp"

namespace qsmpc::harness {
namespace waypoint_drive_test {

/// A Dubins car at 1 m/s with little noise, twice through the same place.
Scenario car_over(const std::string& waypoints, const std::vector<std::string>& overrides = {}) {
  return parse_scenario(
      "name: waypoints\nmodel: {system: dubins_rk4, speed: 1}\n"
      "plant: {kind: analytic, mjcf: \"\"}\n"
      "initial_state: {mean: [0, 0, 0], covariance: [0.0001, 0.0001, 0.0001]}\n"
      "disturbance: {covariance: [0.00001, 0.00001, 0.00001]}\n"
      "target: {waypoints: " +
          waypoints +
          ", radius: 0.3, waypoint_radius: 0.4, angles: [heading]}\n"
          "controller:\n  horizon: 8\n  quantisation: {state: 20, noise: 20, compressed: 20}\n"
          "  cost: {state: [60, 60, 1], input: [0.1], terminal: [60, 60, 5]}\n"
          "limit: {steps: 400}\n",
      {.file = "t.yaml", .overrides = overrides});
}

const std::string kLoop = "[[3, 0], [4.5, 2], [3, 4], [0, 3], [3, 0]]";

TEST(WaypointDrive, passes_them_in_order_and_ends_at_the_last) {
  const Scenario scenario = car_over(kLoop);
  const Trace trace = run_episode(scenario, {.seed = 1});
  const EpisodeView view(trace);
  EXPECT_EQ(view.summary().outcome, "reached");
  const std::optional<WaypointTimes>& passed = view.summary().waypoints;
  ASSERT_TRUE(passed.has_value());
  EXPECT_EQ(passed->wanted, 5);
  ASSERT_EQ(passed->times.size(), 5U);
  EXPECT_TRUE(std::ranges::is_sorted(passed->times));
  EXPECT_EQ(passed->times.back(), view.summary().time_to_target);
  // It was there at these times, independently of the count.
  const Eigen::MatrixXd states = true_states(trace);
  for (std::size_t n = 0; n < passed->times.size(); ++n) {
    const auto k = static_cast<Eigen::Index>(std::lround(passed->times[n] / scenario.time_step));
    const auto i = static_cast<Eigen::Index>(n);
    const Eigen::VectorXd off = states.col(k) - scenario.target.route->states.col(i);
    EXPECT_LE(off.head<2>().norm(), 0.4) << n;
  }
  // The last waypoint equals the first, which does not end the drive early.
  EXPECT_GT(passed->times.back(), passed->times.front() + 5.0);
  const Trace again = run_episode(scenario, {.seed = 1});
  EXPECT_EQ(true_states(again), states);
}

TEST(WaypointDrive, that_is_too_short_reports_which_were_passed) {
  const Trace trace = run_episode(car_over(kLoop, {"limit.steps=45"}), {.seed = 1});
  const EpisodeView view(trace);
  EXPECT_EQ(view.summary().outcome, "timeout");
  ASSERT_TRUE(view.summary().waypoints.has_value());
  const std::size_t passed = view.summary().waypoints->times.size();
  EXPECT_GE(passed, 1U);
  EXPECT_LT(passed, 4U);
}

TEST(WaypointDrive, every_controller_of_ours_drives_over_them) {
  for (const char* kind : {"quantised", "nominal", "lqr", "tube", "cantelli", "mppi", "shield"}) {
    SCOPED_TRACE(kind);
    const Trace trace =
        run_episode(car_over(kLoop, {fmt::format("controller.kind={}", kind)}), {.seed = 2});
    EXPECT_EQ(trace.outcome, Outcome::kReached);
    EXPECT_EQ(waypoint_times(trace)->times.size(), 5U);
  }
}

}  // namespace waypoint_drive_test
}  // namespace qsmpc::harness
