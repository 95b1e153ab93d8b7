#include "harness/report/line_colours.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/figures/palette.hpp"

namespace qsmpc::harness {
namespace line_colours_test {

using ::testing::ElementsAre;

/// A drive along the x axis with these distances per period, m, certified with these risks.
Trace drive(const std::vector<double>& ways, const std::vector<double>& risks) {
  Trace trace;
  trace.scenario.time_step = 0.5;
  trace.system.states = {{"x", "m"}, {"y", "m"}};
  trace.system.position_x = 0;
  trace.system.position_y = 1;
  Eigen::VectorXd state = Eigen::VectorXd::Zero(2);
  for (std::size_t k = 0; k < ways.size(); ++k) {
    StepRecord step;
    step.state = state;
    controller::StageCertificate certificate = controller::blank_certificate();
    certificate.value = risks[k];
    step.certificates = {certificate};
    trace.steps.push_back(step);
    state[0] += ways[k];
  }
  trace.final_state = state;
  return trace;
}

TEST(LineColours, of_speeds_go_from_the_slowest_to_the_fastest) {
  const LineColours colours = speed_colours(drive({0.5, 1.0, 0.75, 1.0}, {0.0, 0.0, 0.0, 0.0}));
  EXPECT_THAT(colours.classes, ElementsAre(0, kScaleSize - 1, 2, kScaleSize - 1));
  ASSERT_EQ(colours.names.size(), static_cast<std::size_t>(kScaleSize));
  EXPECT_EQ(colours.names.front(), "1.00 to 1.20 m/s");
  EXPECT_EQ(colours.names.back(), "1.80 to 2.00 m/s");
}

TEST(LineColours, of_risks_are_decades) {
  const LineColours colours =
      risk_colours(drive({1.0, 1.0, 1.0, 1.0, 1.0}, {0.0, 1e-6, 2e-4, 0.01, 0.5}));
  EXPECT_THAT(colours.classes, ElementsAre(0, 0, 2, 3, 4));
}

TEST(LineColours, of_one_speed_are_one_class) {
  const LineColours colours = speed_colours(drive({1.0, 1.0}, {0.0, 0.0}));
  EXPECT_THAT(colours.classes, ElementsAre(0, 0));
}

TEST(LineColours, runs_of_one_class_are_one_line_and_join) {
  const LineColours colours{
      .title = "", .names = {"a", "b", "c", "d", "e"}, .classes = {1, 1, 0, 1}};
  const std::vector<MapPoint> places = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}};
  const std::vector<MapPath> runs = coloured_line(colours, places);
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[0].name, "a");
  EXPECT_EQ(runs[0].colour, kFirstScale);
  EXPECT_EQ(runs[0].points.size(), 2U);
  EXPECT_EQ(runs[1].points.size(), 3U);
  EXPECT_EQ(runs[1].points.back().x, runs[0].points.front().x);
  EXPECT_EQ(runs[2].points.front().x, runs[0].points.back().x);
}

}  // namespace line_colours_test
}  // namespace qsmpc::harness
