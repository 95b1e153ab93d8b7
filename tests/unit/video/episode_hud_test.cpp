// Rows and charts of the head-up display.

#include "harness/video/episode_hud.hpp"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/video/episode_frames.hpp"
#include "tests/unit/video/straight_episode.hpp"

namespace qsmpc::harness {
namespace episode_hud_test {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST(episode_hud, what_is_not_a_bound_is_not_called_one) {
  Trace trace = straight_trace();
  trace.scenario.disturbance.sensor = Eigen::Matrix3d::Identity();
  const EpisodeView view(trace);
  const render::Frame frame = EpisodeFrames(view).at(0.2);
  EXPECT_EQ(frame.charts[0].label, "next step, no bound");
  EXPECT_THAT(row_of(frame, "plan, no bound"), StartsWith("25"));
  EXPECT_THAT(frame.charts[0].value, Not(HasSubstr("≤")));
  for (const render::HudRow& row : frame.hud) EXPECT_THAT(row.value, Not(HasSubstr("≤")));
}

TEST(episode_hud, speed_is_the_plants_and_neither_the_models_constant_nor_the_noises) {
  Trace trace = straight_trace();
  trace.scenario.model.parameters["speed"] = 9.0;
  // In its third period the plant moves only half of the stride, followed by the same kick.
  for (std::size_t k = 3; k < trace.steps.size(); ++k) trace.steps[k].state.x() -= 0.5 * kStride;
  trace.final_state.x() -= 0.5 * kStride;
  const EpisodeView view(trace);
  const EpisodeFrames frames(view);
  EXPECT_THAT(row_of(frames.at(0.15), "speed"), HasSubstr("1.50"));
  EXPECT_THAT(row_of(frames.at(0.25), "speed"), HasSubstr("0.75"));
  EXPECT_THAT(row_of(frames.at(0.35), "speed"), HasSubstr("1.50"));
}

TEST(episode_hud, a_collision_is_shown_with_its_time_and_as_an_alarm) {
  Trace trace = straight_trace();
  EXPECT_FALSE(EpisodeFrames(EpisodeView(trace)).at(0.6).alarm);
  trace.scenario.safe_set.bounds.upper[0] = 2.5 * kStride;  // left between 0.2 s and 0.3 s
  for (const auto& [outcome, words] :
       {std::pair(Outcome::kCollision, "collision after 0.3 s"),
        std::pair(Outcome::kLeftBounds, "left the bounds after 0.3 s")}) {
    trace.outcome = outcome;
    const EpisodeView view(trace);
    const render::Frame frame = EpisodeFrames(view).at(0.6);
    EXPECT_EQ(frame.banner, words);
    EXPECT_TRUE(frame.alarm);
  }
}

TEST(episode_hud, bounds_are_percentages_that_are_rounded_up) {
  EXPECT_EQ(bound_text(0.35), "≤ 35 %");
  EXPECT_EQ(bound_text(0.3412), "≤ 35 %");
  EXPECT_EQ(bound_text(1.38e-4), "≤ 0.014 %");
  EXPECT_EQ(bound_text(0.9999), "≤ 100 %");
  EXPECT_EQ(bound_text(3.0), "≤ 100 %");
  EXPECT_EQ(bound_text(2e-9), "≤ 0.001 %");
  EXPECT_EQ(bound_text(std::nan("")), "–");
  EXPECT_EQ(percent_text(1e-8), "10⁻⁶ %");
}

TEST(episode_hud, what_rounds_to_zero_has_no_sign) {
  Trace trace = straight_trace();
  const auto text_of = [&trace](double input) {
    for (StepRecord& step : trace.steps) step.input[0] = input;
    return EpisodeFrames(EpisodeView(trace)).at(0.2).charts.at(1).value;
  };
  EXPECT_EQ(text_of(-0.004), "0.00");
  EXPECT_EQ(text_of(-0.006), "−0.01");
  EXPECT_EQ(text_of(1.25), "+1.25");
}

TEST(episode_hud, planning_time_has_the_deadline_as_its_limit) {
  Trace trace = straight_trace();
  const auto limit_of = [](const render::Frame& frame) { return frame.charts.at(3).limit.value(); };
  EXPECT_EQ(limit_of(EpisodeFrames(EpisodeView(trace)).at(0.2)).value, 1000.0 * kPeriod);
  EXPECT_THAT(limit_of(EpisodeFrames(EpisodeView(trace)).at(0.2)).label, HasSubstr("period"));
  trace.scenario.controller.deadline = 0.05;
  EXPECT_EQ(limit_of(EpisodeFrames(EpisodeView(trace)).at(0.2)).value, 50.0);
  EXPECT_THAT(limit_of(EpisodeFrames(EpisodeView(trace)).at(0.2)).label, HasSubstr("deadline"));
  EXPECT_FALSE(
      EpisodeFrames(EpisodeView(trace)).at(0.2).charts.at(0).limit);  // a scenario has none
}

TEST(episode_hud, risk_limits_are_shown_as_kept_or_exceeded) {
  Trace trace = straight_trace();  // next-step certificates 1e-3, 2e-3, …
  EXPECT_EQ(row_of(EpisodeFrames(EpisodeView(trace)).at(0.25), "risk limit"), "no row risk limit");
  trace.scenario.risk = {.stage = 0.5, .mission = 0.005};
  trace.steps[2].solver_status = "risk_exceeded";
  const EpisodeView view(trace);
  const EpisodeFrames frames(view);
  EXPECT_EQ(row_of(frames.at(0.15), "risk limit"), "kept");
  EXPECT_EQ(row_of(frames.at(0.15), "risk spent"), "0.3 % of 0.5 %");
  const render::Frame exceeded = frames.at(0.25);
  EXPECT_EQ(row_of(exceeded, "risk limit"), "exceeded");
  EXPECT_EQ(row_of(exceeded, "risk spent"), "0.6 % of 0.5 %");
  EXPECT_EQ(std::count_if(exceeded.hud.begin(), exceeded.hud.end(),
                          [](const render::HudRow& row) { return row.warning; }),
            2);
}

}  // namespace episode_hud_test
}  // namespace qsmpc::harness
