// An episode as comma-separated values: the contents of each line, and equal numbers of fields in
// all lines, including the header.
#include "harness/trace/trace_csv.hpp"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/trace/episode_view.hpp"
#include "tests/support/example_trace.hpp"

namespace qsmpc::harness {
namespace trace_csv_test {

using Rows = std::vector<std::vector<std::string>>;

/// Fields of lines without quoted fields.
Rows rows_of(const std::string& text) {
  Rows rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> fields{""};
    for (const char c : line) {
      if (c == ',') {
        fields.emplace_back();
      } else {
        fields.back() += c;
      }
    }
    rows.push_back(fields);
  }
  return rows;
}

std::size_t column(const Rows& rows, const std::string& name) {
  const auto at = std::ranges::find(rows.front(), name);
  EXPECT_NE(at, rows.front().end()) << name;
  return static_cast<std::size_t>(at - rows.front().begin());
}

void expect_rectangular(const Rows& rows) {
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows.front().size());
}

TEST(TraceCsv, has_a_line_for_every_control_instant) {
  const Trace trace = testing::example_trace();
  const EpisodeView view(trace);
  const Rows rows = rows_of(episode_csv(view));
  expect_rectangular(rows);
  ASSERT_EQ(rows.size(), trace.steps.size() + 2);  // including the header and the final state
  const StepRecord& second = trace.steps[1];
  EXPECT_DOUBLE_EQ(std::stod(rows[2][column(rows, "time [s]")]), second.time);
  EXPECT_DOUBLE_EQ(std::stod(rows[2][column(rows, "x [m]")]), second.state[0]);
  EXPECT_DOUBLE_EQ(std::stod(rows[2][column(rows, "clearance [m]")]), view.clearances()[1]);
  EXPECT_DOUBLE_EQ(std::stod(rows[2][column(rows, "belief x [m]")]), second.belief_mean[0]);
  EXPECT_DOUBLE_EQ(std::stod(rows[2][column(rows, "P(unsafe at next step) <=")]),
                   second.certificates.front().value);
  // At the last instant only the state is known.
  EXPECT_DOUBLE_EQ(std::stod(rows.back()[column(rows, "x [m]")]), trace.final_state[0]);
  EXPECT_EQ(rows.back()[column(rows, "P(unsafe at next step) <=")], "");
}

TEST(TraceCsv, has_a_line_for_every_stage_of_every_plan) {
  const Trace trace = testing::example_trace();
  const Rows rows = rows_of(plan_csv(EpisodeView(trace)));
  expect_rectangular(rows);
  const auto stages = static_cast<std::size_t>(trace.steps.front().plan_states.cols());
  ASSERT_EQ(rows.size(), 1 + trace.steps.size() * stages);
  const std::size_t bound = column(rows, "P(unsafe) <=");
  EXPECT_EQ(rows[1][bound], "");  // the present is not a certified stage
  EXPECT_DOUBLE_EQ(std::stod(rows[2][bound]), trace.steps[0].certificates[0].value);
  EXPECT_DOUBLE_EQ(std::stod(rows[2][column(rows, "x [m]")]), trace.steps[0].plan_states(0, 1));
  EXPECT_DOUBLE_EQ(std::stod(rows[2][0]), trace.steps[0].time + trace.scenario.time_step);
}

/// The example with a moving obstacle behind a standing one.
Trace moving_trace() {
  Trace trace = testing::example_trace({.steps = 2});
  controller::Obstacle walker(controller::DiscShape{.centre = {5.0, 2.0}, .radius = 0.3});
  walker.motion = models::ObstacleMotion{.ways = {models::steady_way({0.0, 1.0})}};
  trace.scenario.safe_set.obstacles = {trace.scenario.safe_set.obstacles.front(), walker};
  for (StepRecord& step : trace.steps) {
    step.obstacles = Eigen::Vector3d(0.0, step.time, 0.5);
    step.obstacles_seen = Eigen::Vector2d(0.01, step.time - 0.02);
  }
  trace.final_obstacles = Eigen::Vector3d(0.0, 0.2, 0.5);
  return trace;
}

TEST(TraceCsv, has_a_line_for_every_moving_obstacle_at_every_control_instant) {
  const Trace trace = moving_trace();
  const Rows rows = rows_of(obstacles_csv(EpisodeView(trace)));
  expect_rectangular(rows);
  ASSERT_EQ(rows.size(), 4U);  // including the header and the end
  const auto number = [&](std::size_t row, const std::string& name) {
    return std::stod(rows[row][column(rows, name)]);
  };
  EXPECT_DOUBLE_EQ(number(2, "time [s]"), 0.1);
  EXPECT_EQ(rows[2][column(rows, "obstacle")], "1");
  EXPECT_DOUBLE_EQ(number(2, "x [m]"), 5.0);
  EXPECT_DOUBLE_EQ(number(2, "y [m]"), 2.1);
  EXPECT_DOUBLE_EQ(number(2, "turn [rad]"), 0.5);
  EXPECT_DOUBLE_EQ(number(2, "seen x [m]"), 5.01);
  EXPECT_DOUBLE_EQ(number(2, "seen y [m]"), 2.08);
  EXPECT_DOUBLE_EQ(number(3, "y [m]"), 2.2);
  EXPECT_EQ(rows[3][column(rows, "seen x [m]")], "");  // there is no observation after the last
                                                       // period
  const Trace still = testing::example_trace();
  EXPECT_EQ(rows_of(obstacles_csv(EpisodeView(still))).size(), 1U);
}

TEST(TraceCsv, has_a_line_for_every_particle) {
  const Trace trace = testing::example_trace();
  const Rows rows = rows_of(particles_csv(EpisodeView(trace)));
  expect_rectangular(rows);
  std::size_t count = 0;
  double weights = 0.0;
  for (const StepRecord& step : trace.steps) {
    for (const StageParticles& stage : step.particles) {
      count += static_cast<std::size_t>(stage.weights.size());
      weights += stage.weights.sum();
    }
  }
  ASSERT_EQ(rows.size(), count + 1);
  double written = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i)
    written += std::stod(rows[i][column(rows, "weight")]);
  EXPECT_NEAR(written, weights, 1e-9 * weights);
}

}  // namespace trace_csv_test
}  // namespace qsmpc::harness
