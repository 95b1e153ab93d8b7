#include "harness/report/campaign_drives.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "harness/figures/palette.hpp"
#include "harness/figures/svg_figure.hpp"
#include "harness/report/campaign_page.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "tests/unit/campaign/campaign_fixture.hpp"
#include "tests/unit/report/page_checks.hpp"

namespace qsmpc::harness {
namespace campaign_drives_test {

using testing::contains;

/// Drives with costs 1, 2, …, each with a path, in the quick scenario.
VariantStatistics variant(std::int64_t id, const std::vector<std::string>& outcomes) {
  VariantTally tally;
  std::vector<double> costs;
  VariantStatistics statistics;
  for (std::size_t n = 0; n < outcomes.size(); ++n) {
    costs.push_back(static_cast<double>(n + 1));
    tally.add({.outcome = outcomes[n], .cost = costs.back()});
  }
  statistics = tally.result();
  statistics.id = id;
  statistics.name = "quick <b>";
  statistics.scenario_text = to_yaml(testing::quick_scenario());
  statistics.cost = tally.cost().result([&](const auto& visit) {
    for (const double cost : costs) visit(cost);
  });
  for (const std::string& outcome : outcomes) {
    statistics.paths.push_back(
        {.outcome = outcome, .points = {{.x = 0.0, .y = 0.0}, {.x = 1.0, .y = 0.5}}});
  }
  return statistics;
}

CampaignStatistics campaign(std::vector<VariantStatistics> variants) {
  CampaignStatistics statistics;
  statistics.variants = std::move(variants);
  return statistics;
}

TEST(DriveMaps, show_every_drive_coloured_by_its_outcome_those_that_arrived_below) {
  std::vector<std::string> outcomes(11, "reached");
  outcomes[0] = "collision";
  outcomes[1] = "timeout";
  const DriveMaps drives = drive_maps(campaign({variant(0, outcomes)}));
  ASSERT_EQ(drives.maps.size(), 1U);
  const PlaneMap& map = drives.maps[0];
  ASSERT_EQ(map.paths.size(), 11U);
  EXPECT_EQ(map.paths[0].name, "reached (9)");
  EXPECT_EQ(map.paths[0].colour, kGreen);
  EXPECT_TRUE(map.paths[0].faint);
  EXPECT_EQ(map.paths[9].name, "timeout (1)");
  EXPECT_EQ(map.paths[10].colour, kVermilion);
  EXPECT_FALSE(map.paths[10].faint);
  EXPECT_EQ(map.paths[10].end_mark, MapMark::kDot);
  EXPECT_EQ(map.obstacles.size(), 1U);
  EXPECT_EQ(map.targets.size(), 1U);
}

TEST(DriveMaps, of_a_system_without_a_place_in_the_plane_have_the_axes_of_its_episodes_map) {
  VariantStatistics cart = variant(0, {"reached", "collision"});
  cart.scenario_text = to_yaml(load_scenario("cart_pole"));
  const DriveMaps drives = drive_maps(campaign({cart}));
  ASSERT_EQ(drives.maps.size(), 1U);
  EXPECT_EQ(drives.maps[0].x_label, "position (m)");
  EXPECT_EQ(drives.maps[0].y_label, "pole_angle (rad)");
  EXPECT_EQ(drives.maps[0].paths.size(), 2U);
}

TEST(DriveMaps, draw_few_drives_that_arrived_strongly_and_speak_of_no_dots) {
  const DriveMaps drives = drive_maps(campaign({variant(0, {"reached", "reached"})}));
  EXPECT_FALSE(drives.maps.at(0).paths.at(0).faint);
  EXPECT_TRUE(drives.maps[0].note.empty());
}

TEST(DriveMaps, say_what_they_leave_out) {
  VariantStatistics old = variant(0, {"reached", "reached"});
  old.done = 5;
  EXPECT_TRUE(contains(drive_maps(campaign({old})).maps.at(0).note, "2 of 5 drives are drawn"));
  EXPECT_TRUE(contains(drive_maps(campaign({old})).maps.at(0).note, "earlier version"));
  VariantStatistics broken = variant(1, {"reached"});
  broken.scenario_text = "model: {system: none_such}";
  const DriveMaps drives = drive_maps(campaign({broken}));
  EXPECT_TRUE(drives.maps.empty());
  ASSERT_EQ(drives.notes.size(), 1U);
  EXPECT_TRUE(contains(drives.notes[0], "No map of variant 1: quick"));
}

TEST(DriveMaps, of_many_variants_are_of_those_with_the_most_unsafe_drives) {
  std::vector<VariantStatistics> variants(40, variant(0, {"reached"}));
  for (std::size_t n = 0; n < variants.size(); ++n) {
    variants[n].id = static_cast<std::int64_t>(n);
    variants[n].unsafe.events = n >= 30 ? 1 : 0;
  }
  const DriveMaps drives = drive_maps(campaign(variants));
  ASSERT_EQ(drives.maps.size(), 12U);
  EXPECT_TRUE(drives.maps[11].title.starts_with("39: "));
  EXPECT_TRUE(drives.maps[2].title.starts_with("30: "));
  EXPECT_TRUE(contains(drives.notes.at(0), "Of 40 variants, only the 12"));
}

TEST(Distributions, rise_from_the_least_value_to_the_greatest_without_those_of_faults) {
  const std::vector<Chart> charts = distribution_charts(
      campaign({variant(0, {"reached", "collision", "reached", "reached", "timeout"})}));
  ASSERT_EQ(charts.size(), 1U) << "clearance and time are not known";
  ASSERT_EQ(charts[0].series.size(), 1U);
  EXPECT_EQ(charts[0].series[0].x.front(), 1.0);
  EXPECT_EQ(charts[0].series[0].y.front(), 0.0);
  EXPECT_EQ(charts[0].series[0].x.back(), 5.0);
  EXPECT_EQ(charts[0].series[0].y.back(), 1.0);
}

TEST(Distributions, of_more_variants_than_colours_are_ranges) {
  const std::vector<Chart> charts = distribution_charts(
      campaign(std::vector<VariantStatistics>(9, variant(0, {"reached", "reached", "reached"}))));
  ASSERT_EQ(charts.size(), 1U);
  ASSERT_EQ(charts[0].series.size(), 1U);
  EXPECT_EQ(charts[0].series[0].y, std::vector<double>(9, 2.0));
  EXPECT_EQ(charts[0].series[0].lower, std::vector<double>(9, 1.0));
  EXPECT_EQ(charts[0].series[0].upper, std::vector<double>(9, 3.0));
}

TEST(Distributions, of_a_single_value_give_no_chart) {
  EXPECT_TRUE(distribution_charts(campaign({variant(0, {"reached"})})).empty());
  Chart chart{
      .title = "", .x_label = "", .y_label = "", .series = {{.name = "", .x = {1}, .y = {1}}}};
  EXPECT_FALSE(has_places(chart));
  chart.series.push_back({.name = "limit", .dashed = true, .x = {0, 2}, .y = {0, 0}});
  EXPECT_FALSE(has_places(chart));
  chart.series.push_back({.name = "", .x = {2}, .y = {1}});
  EXPECT_TRUE(has_places(chart));
}

TEST(CampaignPage, leads_with_the_outcomes_and_the_map_and_numbers_variants_as_files_do) {
  const std::string page = campaign_page(campaign(
      {variant(4, {"reached", "collision", "reached"}), variant(7, {"reached", "reached"})}));
  EXPECT_EQ(testing::tag_problem(page.substr(page.find("<html"))), "");
  EXPECT_LT(page.find("What became of the drives"), page.find("Driven paths"));
  EXPECT_LT(page.find("Driven paths"), page.find("Cost, clearance, time"));
  EXPECT_LT(page.find("Cost, clearance, time"), page.find("Certificates of the next step"));
  EXPECT_TRUE(contains(page, "<figcaption>4: quick &lt;b&gt;</figcaption>"));
  EXPECT_TRUE(contains(page, "<figcaption>7: quick &lt;b&gt;</figcaption>"));
  EXPECT_FALSE(contains(page, "<b>"));
}

}  // namespace campaign_drives_test
}  // namespace qsmpc::harness
