#include "harness/report/tradeoff_charts.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "harness/campaign/plan/campaign_keys.hpp"
#include "harness/figures/palette.hpp"
#include "harness/figures/svg_figure.hpp"
#include "harness/report/campaign_charts.hpp"
#include "harness/report/campaign_page.hpp"
#include "tests/unit/report/page_checks.hpp"

namespace qsmpc::harness {
namespace tradeoff_charts_test {

static_assert(kMostFamilies <= kPaletteSize, "each family has a colour of its own");

/// 100 drives, some unsafe and some timed out.
VariantStatistics variant(const std::string& settings, int unsafe, int timeouts) {
  VariantTally tally;
  for (int n = 0; n < 100; ++n) {
    EpisodeRow row;
    row.outcome = n < unsafe ? "collision" : n < unsafe + timeouts ? "timeout" : "reached";
    row.unsafe = n < unsafe;
    tally.add(row);
  }
  VariantStatistics statistics = tally.result();
  statistics.name = "a.yaml / " + settings;
  statistics.settings = settings;
  return statistics;
}

CampaignStatistics tradeoff_example() {
  const auto cost = [](double mean) {
    return DriveMean{
        .drives = 90, .mean = mean, .interval = {.lower = mean - 5.0, .upper = mean + 5.0}};
  };
  CampaignStatistics statistics;
  statistics.variants = {variant("w2", 20, 0), variant("w20", 1, 30), variant("<b>", 0, 0),
                         variant("never", 0, 100)};
  for (std::size_t n = 0; n < statistics.variants.size(); ++n) {
    statistics.variants[n].id = static_cast<std::int64_t>(n);
  }
  statistics.tradeoff = {
      {.scenario = "a.yaml",
       .plant = "",
       .families = {
           {.name = "penalties",
            .points = {{.variant = 0, .cost = cost(100.0)}, {.variant = 1, .cost = cost(150.0)}}},
           {.name = "limits & more",
            .points = {{.variant = 2, .cost = cost(120.0)}, {.variant = 3, .cost = {}}}}}}};
  return statistics;
}

TEST(TradeoffCharts, have_a_point_a_variant_and_a_series_a_family) {
  const std::vector<Chart> charts = tradeoff_charts(tradeoff_example());
  ASSERT_EQ(charts.size(), 2U);
  const Chart& chart = charts[0];
  ASSERT_EQ(chart.series.size(), 2U);
  EXPECT_EQ(chart.series[0].name, "penalties");
  EXPECT_NE(chart.series[0].colour, chart.series[1].colour);
  for (const Series& series : chart.series) {
    EXPECT_EQ(series.mark, Mark::kJoined);
    for (const auto* values :
         {&series.x, &series.y, &series.lower, &series.upper, &series.x_lower, &series.x_upper}) {
      EXPECT_EQ(values->size(), 2U);
    }
    EXPECT_EQ(series.labels.size(), 2U);
  }
  EXPECT_DOUBLE_EQ(chart.series[0].x[0], 0.2);
  EXPECT_LT(chart.series[0].x_lower[0], 0.2);
  EXPECT_GT(chart.series[0].x_upper[0], 0.2);
  EXPECT_DOUBLE_EQ(chart.series[0].y[1], 150.0);
  EXPECT_DOUBLE_EQ(chart.series[0].upper[1], 155.0);
  EXPECT_EQ(chart.series[0].labels[1], "w20");
}

TEST(TradeoffCharts, say_what_is_not_a_bound_beside_what_was_certified_alone) {
  CampaignStatistics statistics = tradeoff_example();
  EXPECT_FALSE(testing::contains(tradeoff_charts(statistics)[1].note, "NO BOUND"));
  statistics.variants[1].no_bound = "for a reason";
  std::vector<Chart> charts = tradeoff_charts(statistics);
  EXPECT_FALSE(testing::contains(charts[0].note, "NO BOUND"));
  EXPECT_TRUE(testing::contains(charts[1].note, "NO BOUND: w20."));
  EXPECT_EQ(charts[1].x_label, "mean certified risk of a drive, no bound (–)");
  const std::string section = tradeoff_section(statistics);
  EXPECT_EQ(testing::occurrences(section, "<strong>no bound</strong>"), 1U);
  EXPECT_TRUE(testing::contains(section, "No bound in variant 1: for a reason."));
  for (VariantStatistics& variant : statistics.variants) variant.no_bound = "for a reason";
  EXPECT_TRUE(testing::contains(tradeoff_charts(statistics)[1].note, "NO BOUND for any variant."));
}

TEST(TradeoffCharts, show_what_was_certified_beside_what_was_observed) {
  CampaignStatistics statistics = tradeoff_example();
  statistics.tradeoff[0].families[0].points[1].certified = {
      .drives = 100, .mean = 3e-4, .interval = {.lower = 1e-4, .upper = 9e-4}};
  const Chart chart = tradeoff_charts(statistics)[1];
  EXPECT_EQ(chart.title, "Certified risk against cost: a.yaml");
  EXPECT_FALSE(chart.x_has_zero);
  EXPECT_DOUBLE_EQ(chart.series[0].x[1], 3e-4);
  EXPECT_DOUBLE_EQ(chart.series[0].x_upper[1], 9e-4);
  EXPECT_DOUBLE_EQ(chart.series[0].y[1], 150.0);
  EXPECT_TRUE(testing::contains(chart.in_words, "w20 certified 3"));
}

TEST(TradeoffCharts, have_a_place_for_zero_and_begin_below_one_drive) {
  const Chart chart = tradeoff_charts(tradeoff_example())[0];
  EXPECT_EQ(chart.x_scale, Scale::kLog);
  EXPECT_TRUE(chart.x_has_zero);
  EXPECT_DOUBLE_EQ(chart.series[1].x[0], 0.0);
  EXPECT_NEAR(chart.least_x, 1e-3, 1e-15) << "one of 100 drives is 1e-2";  // rounding of pow
  EXPECT_TRUE(testing::contains(chart_drawing(chart), ">0</text>"));
}

TEST(TradeoffCharts, say_how_many_drives_did_not_reach_the_target) {
  CampaignStatistics statistics = tradeoff_example();
  EXPECT_EQ(tradeoff_charts(statistics)[0].note,
            "All drives reached the target, except: w2 80 of 100, w20 69 of 100 (30 timed out), "
            "never 0 of 100 (100 timed out).");
  statistics.variants.assign(4, variant("fine", 0, 0));
  EXPECT_EQ(tradeoff_charts(statistics)[0].note, "All drives reached the target.");
}

TEST(TradeoffCharts, are_described_in_words) {
  const std::string words = tradeoff_charts(tradeoff_example())[0].in_words;
  EXPECT_TRUE(testing::contains(words, "penalties: w2 20 % unsafe, mean cost 100; w20 1 % unsafe"));
  EXPECT_TRUE(testing::contains(words, "never 0 % unsafe, mean cost none."));
}

TEST(TradeoffSection, lists_every_variant_with_drives_that_reached_and_timed_out) {
  const std::string html = tradeoff_section(tradeoff_example());
  EXPECT_EQ(testing::tag_problem(html), "");
  EXPECT_FALSE(testing::contains(html, "<b>"));
  EXPECT_EQ(testing::occurrences(html, "<th scope=\"row\">"), 4);
  EXPECT_TRUE(testing::contains(html,
                                "<th scope=\"row\">1: a.yaml / w20</th><td class=\"text\">penalties"
                                "</td><td>100</td><td>69</td><td>30</td><td>1</td>"));
  EXPECT_EQ(tradeoff_section({}), "");
}

TEST(TradeoffFigure, is_a_document_where_the_campaign_asks_for_it) {
  CampaignStatistics statistics = tradeoff_example();
  const auto has_figure = [&] {
    return std::ranges::any_of(campaign_figures(statistics), [](const CampaignFigure& figure) {
      return figure.file == kTradeoffFile;
    });
  };
  ASSERT_TRUE(has_figure());
  const std::string svg = svg_figure(campaign_figures(statistics).back().charts);
  EXPECT_EQ(testing::tag_problem(svg.substr(svg.find("<svg"))), "");
  EXPECT_FALSE(testing::contains(svg, "<b>"));
  EXPECT_FALSE(testing::contains(svg, "nan"));
  EXPECT_EQ(testing::occurrences(campaign_page(statistics, {}), ">Risk against cost: a.yaml<"), 1);
  statistics.tradeoff.clear();
  EXPECT_FALSE(has_figure());
  EXPECT_FALSE(testing::contains(campaign_page(statistics, {}), "Risk against cost"));
}

TEST(TradeoffFigure, of_no_drives_exists) {
  CampaignStatistics statistics = tradeoff_example();
  for (VariantStatistics& one : statistics.variants) one = VariantTally().result();
  for (TradeoffFamily& family : statistics.tradeoff[0].families) {
    for (TradeoffPoint& point : family.points) point.cost = {};
  }
  EXPECT_TRUE(
      testing::contains(svg_figure(tradeoff_charts(statistics)), "No finite values to draw."));
}

}  // namespace tradeoff_charts_test
}  // namespace qsmpc::harness
