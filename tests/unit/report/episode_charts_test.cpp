#include "harness/report/episode_charts.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "models/constants.hpp"
#include "tests/support/example_trace.hpp"
#include "tests/unit/report/page_checks.hpp"

namespace qsmpc::harness {
namespace episode_charts_test {

using testing::contains;

Chart chart_of(const Trace& trace, const std::string& title) {
  const EpisodeView view(trace);
  const std::vector<Chart> charts = episode_charts(view);
  const auto found = std::ranges::find_if(
      charts, [&](const Chart& chart) { return chart.title.starts_with(title); });
  return found == charts.end() ? Chart{} : *found;
}

/// A drive with inputs from 0 to 1 and bounds ±`bound`.
Trace bounded(double bound) {
  Trace trace = testing::example_trace({.steps = 5});
  for (std::size_t k = 0; k < trace.steps.size(); ++k) {
    trace.steps[k].input.setConstant(0.25 * static_cast<double>(k));
  }
  trace.scenario.controller.input_lower.setConstant(1, -bound);
  trace.scenario.controller.input_upper.setConstant(1, bound);
  return trace;
}

TEST(EpisodeCharts, draw_bounds_that_leave_room_to_the_input) {
  const Chart chart = chart_of(bounded(1.5), "Input: ");
  ASSERT_EQ(chart.rules.size(), 2U);
  EXPECT_EQ(chart.rules[0].name, "bounds");
  EXPECT_TRUE(chart.rules[1].name.empty());
  EXPECT_FALSE(contains(chart.note, "Beyond the scale"));
}

TEST(EpisodeCharts, say_bounds_once_that_would_press_the_input_flat) {
  const Chart chart = chart_of(bounded(80.0), "Input: ");
  EXPECT_TRUE(chart.rules.empty());
  EXPECT_TRUE(contains(chart.note, "Beyond the scale: bounds −80, 80 rad/s.")) << chart.note;
}

TEST(EpisodeCharts, name_the_bound_that_is_drawn_where_the_other_is_a_note) {
  Trace trace = bounded(1.2);
  trace.scenario.controller.input_lower.setConstant(1, -50.0);
  const Chart chart = chart_of(trace, "Input: ");
  ASSERT_EQ(chart.rules.size(), 1U);
  EXPECT_EQ(chart.rules[0].name, "bounds");
  EXPECT_EQ(chart.rules[0].value, 1.2);
  EXPECT_TRUE(contains(chart.note, "Beyond the scale: bounds −50 rad/s.")) << chart.note;
}

TEST(EpisodeCharts, say_a_control_period_far_longer_than_all_solve_times) {
  Trace trace = testing::example_trace({.steps = 5});
  for (StepRecord& step : trace.steps) step.timing = {.optimise = 0.5, .total = 1.0};
  trace.scenario.time_step = 0.1;
  for (const char* title : {"Solve time against", "Solve times: "}) {
    const Chart chart = chart_of(trace, title);
    EXPECT_TRUE(chart.rules.empty()) << title;
    EXPECT_TRUE(contains(chart.note, "Beyond the scale: control period 100 ms.")) << chart.note;
    EXPECT_TRUE(std::ranges::none_of(
        chart.series, [](const Series& series) { return series.name == "control period"; }));
  }
  for (StepRecord& step : trace.steps) step.timing.total = 60.0;
  EXPECT_EQ(chart_of(trace, "Solve time against").rules.size(), 1U);
}

TEST(EpisodeCharts, budgets_of_very_different_sizes_are_on_a_logarithmic_axis) {
  Trace trace = testing::example_trace({.steps = 5});
  for (StepRecord& step : trace.steps) step.budgets.back().total = 0.4;
  EXPECT_EQ(chart_of(trace, "Error budget").y_scale, Scale::kLinear);
  trace.steps.front().budgets.back().total = 2e9;
  const Chart chart = chart_of(trace, "Error budget");
  EXPECT_EQ(chart.y_scale, Scale::kLog);
  EXPECT_TRUE(contains(chart.note, "drawn at the bottom")) << chart.note;
  // A value that is not finite is omitted and does not affect the scale.
  trace.steps.front().budgets.back().total = kInfinity;
  EXPECT_EQ(chart_of(trace, "Error budget").y_scale, Scale::kLinear);
}

TEST(EpisodeCharts, units_have_raised_powers) {
  Trace trace = testing::example_trace({.steps = 2});
  trace.system.inputs.front().unit = "m/s^2";
  EXPECT_TRUE(contains(chart_of(trace, "Input: ").y_label, "(m/s²)"));
}

}  // namespace episode_charts_test
}  // namespace qsmpc::harness
