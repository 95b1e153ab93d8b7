#include "harness/campaign/store/episode_row.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/example_trace.hpp"

namespace qsmpc::harness {
namespace episode_row_test {

TEST(EpisodeRow, has_a_period_for_every_step_that_the_plant_came_through) {
  Trace trace = testing::example_trace({.steps = 6});
  EXPECT_EQ(episode_row(EpisodeView(trace), 0).periods.size(), 6U);
  trace.outcome = Outcome::kFault;
  EXPECT_EQ(episode_row(EpisodeView(trace), 0).periods.size(), 5U);
  trace.final_state.resize(0);
  EXPECT_EQ(episode_row(EpisodeView(trace), 0).periods.size(), 5U);
}

TEST(EpisodeRow, says_of_a_period_whether_the_state_at_its_end_was_unsafe) {
  Trace trace = testing::example_trace({.steps = 3});
  for (StepRecord& step : trace.steps) step.state << 0.0, 0.0, 0.0;
  trace.final_state = trace.steps.front().state;
  trace.steps[2].state << 3.0, 4.0, 0.0;  // within an obstacle
  const EpisodeRow row = episode_row(EpisodeView(trace), 0);
  ASSERT_EQ(row.periods.size(), 3U);
  EXPECT_FALSE(row.periods[0].unsafe);
  EXPECT_TRUE(row.periods[1].unsafe);
  EXPECT_FALSE(row.periods[2].unsafe);
  EXPECT_TRUE(row.unsafe);
}

TEST(EpisodeRow, takes_the_certificate_of_the_next_step) {
  const Trace trace = testing::example_trace({});
  const EpisodeRow row = episode_row(EpisodeView(trace), 7);
  EXPECT_EQ(row.variant, 7);
  for (std::size_t k = 0; k < row.periods.size(); ++k) {
    EXPECT_EQ(row.periods[k].certified, trace.steps[k].certificates.front().value);
    EXPECT_EQ(row.periods[k].published, trace.steps[k].certificates.front().of("thesis"));
    EXPECT_EQ(row.periods[k].ocp_ms, trace.steps[k].timing.total);
  }
}

TEST(EpisodeRow, has_the_numbers_of_the_summary) {
  Trace trace = testing::example_trace({});
  controller::StageCertificate& first = trace.steps[1].certificates.front();
  first.figures.resize(controller::certificate_entries().size(), 0.0);
  first.figures[controller::certificate_index("thesis")] = 0.25;
  const EpisodeView view(trace);
  const Summary& summary = view.summary();
  const EpisodeRow row = episode_row(view, 0);
  EXPECT_EQ(row.seed, summary.seed);
  EXPECT_EQ(row.outcome, summary.outcome);
  EXPECT_EQ(row.steps, summary.steps);
  EXPECT_EQ(row.min_clearance, summary.min_clearance);
  EXPECT_EQ(row.cost, summary.closed_loop_cost);
  EXPECT_EQ(row.next_step_max, summary.next_step_max);
  EXPECT_EQ(row.next_step_sum, summary.next_step_sum);
  EXPECT_EQ(row.horizon_max, summary.horizon_max);
  EXPECT_EQ(row.thesis_max, summary.thesis_max);
  EXPECT_EQ(row.iterations_median, summary.iterations_median);
  EXPECT_EQ(row.version, summary.version);
  // None of these is what a row has by default.
  const EpisodeRow none;
  EXPECT_NE(row.thesis_max, none.thesis_max);
  EXPECT_NE(row.horizon_max, none.horizon_max);
  EXPECT_NE(row.next_step_sum, none.next_step_sum);
  EXPECT_NE(row.next_step_max, none.next_step_max);
  EXPECT_NE(row.iterations_median, none.iterations_median);
}

TEST(EpisodeRow, keeps_a_path_of_few_points_that_ends_where_the_drive_did) {
  Trace trace = testing::example_trace({.steps = 500});
  const EpisodeRow row = episode_row(EpisodeView(trace), 0);
  EXPECT_LE(row.path.size(), kMostPathPoints);
  EXPECT_GT(row.path.size(), kMostPathPoints / 2);
  EXPECT_NEAR(row.path.front().x, trace.steps.front().state[0], 1e-4);
  EXPECT_NEAR(row.path.back().x, trace.final_state[0], 1e-5 * std::abs(trace.final_state[0]));
  EXPECT_NEAR(row.path.back().y, trace.final_state[1], 1e-5 * std::abs(trace.final_state[1]));
}

TEST(EpisodeRow, keeps_every_state_of_a_short_path_once) {
  const Trace trace = testing::example_trace({.steps = 6});
  const EpisodeRow row = episode_row(EpisodeView(trace), 0);
  ASSERT_EQ(row.path.size(), 7U);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(row.path[k].x, trace.steps[k].state[0], 1e-4);
  EXPECT_NEAR(row.path[6].x, trace.final_state[0], 1e-4);
}

TEST(EpisodeRow, keeps_the_two_states_of_the_map_of_a_system_without_a_place_in_the_plane) {
  Trace trace = testing::example_trace({.steps = 500});
  trace.system.position_x = -1;
  const EpisodeRow row = episode_row(EpisodeView(trace), 0);  // x and heading
  ASSERT_FALSE(row.path.empty());
  EXPECT_NEAR(row.path.back().x, trace.final_state[0], 1e-5 * std::abs(trace.final_state[0]));
  EXPECT_NEAR(row.path.back().y, trace.final_state[2], 1e-5 * std::abs(trace.final_state[2]));
  for (models::Coordinate& state : trace.system.states) state.unit = "";
  EXPECT_TRUE(episode_row(EpisodeView(trace), 0).path.empty());
}

TEST(EpisodeRow, is_a_failure_unless_the_target_was_reached_and_no_state_was_unsafe) {
  EXPECT_FALSE(is_failure({.outcome = "reached", .unsafe = false}));
  EXPECT_TRUE(is_failure({.outcome = "reached", .unsafe = true}));
  EXPECT_TRUE(is_failure({.outcome = "timeout", .unsafe = false}));
  EXPECT_TRUE(is_failure({.outcome = "fault", .unsafe = false}));
}

}  // namespace episode_row_test
}  // namespace qsmpc::harness
