// Drives along paths: laps, the end of an open path, edges, and a third-party track.
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "harness/episode/episode.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/ending.hpp"
#include "harness/trace/episode_view.hpp"
#include "harness/trace/target_progress.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace path_drive_test {

/// A Dubins car at 1 m/s with little noise that follows `target`.
Scenario car_along(const std::string& target, const std::vector<std::string>& overrides = {}) {
  return parse_scenario(
      "name: path\nmodel: {system: dubins_rk4, speed: 1}\n"
      "plant: {kind: analytic, mjcf: \"\"}\n"
      "initial_state: {mean: [0, 0, 0], covariance: [0.0001, 0.0001, 0.0001]}\n"
      "disturbance: {covariance: [0.00001, 0.00001, 0.00001]}\n"
      "target: " +
          target +
          "\ncontroller:\n  horizon: 8\n  quantisation: {state: 20, noise: 20, compressed: 20}\n"
          "  cost: {state: [60, 60, 1], input: [0.1], terminal: [60, 60, 5]}\n"
          "limit: {steps: 400}\n",
      {.file = "t.yaml", .overrides = overrides});
}

/// A circle of this radius to the left of the origin, with these widths.
std::string circle(double radius, const std::string& widths) {
  std::string rows;
  for (int i = 0; i < 24; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 24;
    rows += fmt::format("{}[{}, {}{}]", i > 0 ? ", " : "", radius * std::sin(angle),
                        radius * (1.0 - std::cos(angle)), widths);
  }
  return "[" + rows + "]";
}

TEST(PathDrive, stops_after_its_laps_and_times_them) {
  const Scenario scenario = car_along("{path: " + circle(2.0, ", 0.5, 0.5") + ", laps: 2}");
  const Trace trace = run_episode(scenario, {.seed = 1});
  const EpisodeView view(trace);
  const Summary& summary = view.summary();
  EXPECT_EQ(summary.outcome, "reached");
  ASSERT_TRUE(summary.laps.has_value());
  EXPECT_EQ(summary.laps->wanted, 2);
  ASSERT_EQ(summary.laps->times.size(), 2U);
  const double length = scenario.target.course->path->length();
  // At 1 m/s, with cut corners and detours: two centimetres off a radius of 2 m.
  for (const double time : summary.laps->times) EXPECT_NEAR(time, length, 0.05 * length);
  EXPECT_NEAR(*summary.distance, 2.0 * length, 0.2);
  ASSERT_TRUE(summary.time_to_target.has_value());
  EXPECT_NEAR(*summary.time_to_target, summary.laps->times[0] + summary.laps->times[1], 0.1001);
}

TEST(PathDrive, ends_at_the_end_of_an_open_path_also_where_it_crosses_itself) {
  // A loop as in a knot: the end is close to the beginning and crosses it.
  const Scenario scenario = car_along(
      "{path: [[0, 0], [2, 0], [4, 0], [5.5, 1.5], [4, 3], [2.5, 1.5], [2.5, 0], [2.5, -2]], "
      "radius: 0.3}");
  const Trace trace = run_episode(scenario, {.seed = 2});
  EXPECT_EQ(trace.outcome, Outcome::kReached);
  const std::vector<double> along = progress_of(trace);
  for (std::size_t k = 1; k < along.size(); ++k) {
    EXPECT_GT(along[k], along[k - 1] - 0.02);
    EXPECT_LT(along[k], along[k - 1] + 0.3) << "no jump to the other stretch";
  }
  EXPECT_FALSE(laps_of(trace).has_value());
}

TEST(PathDrive, that_touches_an_edge_has_left_bounds) {
  // A bend tighter than the car can turn.
  const Scenario scenario = car_along(
      "{path: [[0, 0, 0.3, 0.3], [2, 0, 0.3, 0.3], [2.6, 0.6, 0.3, 0.3], [2.6, 3, 0.3, 0.3]]}",
      {"controller.input_bounds={yaw_rate: [-0.2, 0.2]}"});
  EXPECT_EQ(run_episode(scenario, {.seed = 3}).outcome, Outcome::kLeftBounds);
}

TEST(PathDrive, every_controller_of_ours_follows) {
  for (const char* kind : {"quantised", "nominal", "lqr", "tube", "cantelli", "mppi", "shield"}) {
    SCOPED_TRACE(kind);
    const Scenario scenario =
        car_along("{path: " + circle(2.0, "") + "}", {fmt::format("controller.kind={}", kind)});
    const Trace trace = run_episode(scenario, {.seed = 4});
    EXPECT_EQ(trace.outcome, Outcome::kReached);
    for (const StepRecord& step : trace.steps) {
      const double off = (step.state.head<2>() - Eigen::Vector2d(0.0, 2.0)).norm() - 2.0;
      EXPECT_LT(std::abs(off), 0.35) << step.time;
    }
  }
}

TEST(PathDrive, a_track_of_a_thousand_points_is_driven_as_it_is) {
  // A circuit of 3 km in the format of public collections; a car at 30 m/s looks 2.4 s ahead.
  testing::TemporaryFolder folder;
  std::string track = "# x_m,y_m,w_tr_right_m,w_tr_left_m\n";
  for (int i = 0; i < 1000; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 1000;
    const double radius = 400.0 + 90.0 * std::sin(3.0 * angle) + 30.0 * std::cos(5.0 * angle);
    track += fmt::format("{:.4f},{:.4f},{:.3f},{:.3f}\n", radius * std::cos(angle),
                         radius * std::sin(angle), 5.5 + std::sin(7.0 * angle),
                         5.5 + std::cos(4.0 * angle));
  }
  (void)folder.file("circuit.csv", track);
  const std::string file = folder.file(
      "s.yaml",
      "name: circuit\nmodel: {system: dubins_rk4, speed: 30}\n"
      "plant: {kind: analytic, mjcf: \"\"}\n"
      "initial_state: {mean: [430, 0, 1.1], covariance: [0.01, 0.01, 0.00001]}\n"
      "disturbance: {covariance: [0.0004, 0.0004, 0.0000001]}\n"
      "vehicle: {footprint: [{radius: 1}]}\n"
      "target: {path: circuit.csv}\nrisk: {plan: 0.02}\n"
      "controller:\n  horizon: 12\n  quantisation: {state: 20, noise: 20, compressed: 20}\n"
      "  cost: {state: [1, 1, 20], input: [10], terminal: [1, 1, 20]}\n"
      "limit: {steps: 1500}\n");
  const Scenario scenario = load_scenario(file);
  EXPECT_EQ(scenario.target.path.rows.rows(), 1000);
  const Trace trace = run_episode(scenario, {.seed = 5});
  const EpisodeView view(trace);
  EXPECT_EQ(view.summary().outcome, "reached");
  ASSERT_TRUE(view.summary().laps.has_value());
  EXPECT_EQ(view.summary().laps->times.size(), 1U);
  EXPECT_LE(view.summary().risk.plan.certified, 0.02);
}

}  // namespace path_drive_test
}  // namespace qsmpc::harness
