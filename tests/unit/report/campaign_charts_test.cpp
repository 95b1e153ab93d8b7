#include "harness/report/campaign_charts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "harness/figures/plot_frame.hpp"
#include "harness/figures/svg_figure.hpp"
#include "harness/report/campaign_outcomes.hpp"
#include "harness/report/campaign_page.hpp"
#include "harness/text/number_format.hpp"
#include "tests/unit/report/page_checks.hpp"

namespace qsmpc::harness {
namespace campaign_charts_test {

using testing::contains;
using testing::occurrences;
using testing::tag_problem;

VariantStatistics variant(const std::string& name, int unsafe_every) {
  VariantTally tally;
  for (int n = 0; n < 1000; ++n) {
    EpisodeRow row;
    row.outcome = "reached";
    tally.add(row);
    tally.add(0, {.certified = 1e-3, .published = 1e-5, .unsafe = n % unsafe_every == 0});
    tally.add(1, {.certified = 1e-7, .published = 1e-9});
  }
  VariantStatistics statistics = tally.result();
  statistics.name = name;
  return statistics;
}

CampaignStatistics example() {
  CampaignStatistics statistics;
  statistics.variants = {variant("seldom", 2000), variant("often <b>", 10)};
  statistics.variants[1].id = 1;
  statistics.calibration = statistics.variants[1].calibration;
  statistics.published = statistics.variants[1].published;
  VariantDifference difference{.pair = {.variant = 1, .baseline = 0}};
  for (const std::string& quantity : paired_quantities()) {
    difference.quantities.push_back(
        {.quantity = quantity, .pairs = 10, .mean = 0.5, .interval = {.lower = 0.4, .upper = 0.7}});
  }
  statistics.differences = {difference};
  return statistics;
}

const Series* series_of(const Chart& chart, const std::string& name) {
  const auto found = std::ranges::find(chart.series, name, &Series::name);
  return found == chart.series.end() ? nullptr : &*found;
}

TEST(CampaignFigures, are_documents_with_texts_that_are_escaped) {
  const std::vector<CampaignFigure> figures = campaign_figures(example());
  ASSERT_EQ(figures.size(), 3U);
  EXPECT_EQ(figures[0].file, "outcomes.svg");
  EXPECT_EQ(figures[1].file, "reliability.svg");
  EXPECT_EQ(figures[2].file, "differences.svg");
  for (const CampaignFigure& figure : figures) {
    const std::string svg = svg_figure(figure.charts);
    EXPECT_EQ(testing::tag_problem(svg.substr(svg.find("<svg"))), "") << figure.file;
    EXPECT_FALSE(testing::contains(svg, "<b>")) << figure.file;
    EXPECT_FALSE(testing::contains(svg, "nan")) << figure.file;
    EXPECT_FALSE(testing::contains(svg, "inf")) << figure.file;
  }
}

TEST(CampaignFigures, of_no_episodes_exist) {
  CampaignStatistics statistics;
  statistics.variants = {VariantTally().result()};
  statistics.calibration = statistics.published = statistics.variants[0].calibration;
  for (const CampaignFigure& figure : campaign_figures(statistics)) {
    EXPECT_NE(figure.file, "differences.svg");
    EXPECT_TRUE(testing::contains(svg_figure(figure.charts), "No finite values to draw."))
        << figure.file;
  }
}

TEST(ReliabilityFigure, says_where_certificates_are_not_bounds_and_calls_none_of_those_exceeded) {
  CampaignStatistics statistics = example();
  EXPECT_FALSE(testing::contains(campaign_page(statistics), "No bound"));
  statistics.variants[1].no_bound = "for a reason";
  std::vector<Chart> charts = campaign_figures(statistics)[1].charts;
  ASSERT_EQ(charts.size(), 4U);
  EXPECT_TRUE(testing::contains(charts[0].note, "No bound in variant 1: for a reason."));
  EXPECT_EQ(charts[2].title, "0: seldom");
  EXPECT_FALSE(testing::contains(charts[2].note, "reason"));
  EXPECT_EQ(charts[3].title, "1: often <b>: NO BOUND");
  EXPECT_TRUE(testing::contains(charts[3].note, "No bound: for a reason."));
  EXPECT_NE(series_of(charts[3], "certificate, not a bound"), nullptr);
  EXPECT_EQ(series_of(charts[3], "certificate, not a bound: exceeded"), nullptr);
  EXPECT_NE(series_of(charts[0], "certificate: exceeded"), nullptr) << "some are bounds";

  statistics.variants[0].no_bound = "for a reason";
  charts = campaign_figures(statistics)[1].charts;
  EXPECT_TRUE(testing::contains(charts[0].note, "not bounds here. No bound: for a reason."));
  EXPECT_EQ(series_of(charts[0], "certificate: exceeded"), nullptr);
  EXPECT_TRUE(testing::contains(campaign_page(statistics), "Certificates: not bounds here"));
}

TEST(ReliabilityFigure, draws_bins_with_events_as_points_and_others_at_zero_below_what_is_shaded) {
  const Chart chart = campaign_figures(example())[1].charts[0];
  const Series* exceeded = series_of(chart, "certificate: exceeded");
  ASSERT_NE(exceeded, nullptr) << "one of ten where one of a thousand is certified";
  EXPECT_EQ(exceeded->x.size(), 1U);
  EXPECT_DOUBLE_EQ(exceeded->y[0], 0.1);
  EXPECT_LT(exceeded->lower[0], 0.1);
  EXPECT_GT(exceeded->upper[0], 0.1);
  EXPECT_EQ(series_of(chart, "certificate"), nullptr);
  const Series* published = series_of(chart, "published value, not a bound");
  ASSERT_NE(published, nullptr);
  EXPECT_EQ(published->x.size(), 1U);
  EXPECT_EQ(series_of(chart, "published value, not a bound: exceeded"), nullptr);
  for (const char* name :
       {"certificate: none unsafe", "published value, not a bound: none unsafe"}) {
    const Series* unseen = series_of(chart, name);
    ASSERT_NE(unseen, nullptr) << name;
    EXPECT_EQ(unseen->y, std::vector<double>{0.0});
    EXPECT_GT(unseen->upper[0], 0.0);
  }
  const PlotFrame frame = frame_of(chart);
  const std::vector<double>& edge = chart.areas.at(0).y;
  EXPECT_GT(frame.up(0.0), frame.up(std::ranges::min(edge)) + 5.0) << "heights grow downwards";
  EXPECT_TRUE(testing::contains(chart.note, "in 1 of 2 bins"));
}

TEST(ReliabilityFigure, shades_what_is_above_the_diagonal) {
  const Chart chart = campaign_figures(example())[1].charts[0];
  ASSERT_EQ(chart.areas.size(), 1U);
  for (std::size_t i = 0; i < chart.areas[0].x.size(); ++i) {
    EXPECT_GE(chart.areas[0].y[i], chart.areas[0].x[i]);
  }
  const std::string svg = chart_drawing(chart);
  EXPECT_EQ(testing::occurrences(svg, "class=\"area\""), 1);
  EXPECT_LT(svg.find("class=\"area\""), svg.find("class=\"grid-line\"")) << "beneath all else";
}

TEST(ReliabilityFigure, has_a_chart_for_each_of_several_variants) {
  CampaignStatistics statistics = example();
  EXPECT_EQ(campaign_figures(statistics)[1].charts.size(), 4U);
  statistics.variants.pop_back();
  statistics.differences.clear();
  EXPECT_EQ(campaign_figures(statistics)[1].charts.size(), 2U);
  statistics.variants.assign(100, statistics.variants[0]);
  EXPECT_LT(campaign_figures(statistics)[1].charts.size(), 20U);
}

TEST(ReliabilityFigure, says_which_of_many_variants_have_a_chart) {
  CampaignStatistics statistics = example();
  const VariantStatistics exceeded = statistics.variants[1];
  statistics.variants.assign(40, statistics.variants[0]);
  statistics.variants[33] = exceeded;
  for (std::size_t n = 0; n < 40; ++n) statistics.variants[n].id = static_cast<std::int64_t>(n);
  const std::vector<Chart> charts = campaign_figures(statistics)[1].charts;
  ASSERT_EQ(charts.size(), 2U + 16U);
  EXPECT_TRUE(testing::contains(charts[0].note, "Of 40 variants, 16 have their own chart"));
  EXPECT_TRUE(charts[2].title.starts_with("0: ")) << charts[2].title;
  EXPECT_TRUE(charts[17].title.starts_with("33: ")) << charts[17].title;
}

TEST(OutcomeFigure, has_room_for_many_variants) {
  CampaignStatistics statistics = example();
  statistics.variants.assign(100, statistics.variants[0]);
  const Chart chart = campaign_figures(statistics)[0].charts[0];
  EXPECT_EQ(chart.series[0].x.size(), 100U);
  EXPECT_LE(std::ranges::count_if(chart.x_names, [](const auto& name) { return !name.empty(); }),
            20);
}

TEST(CampaignFigures, begin_the_certified_axis_where_the_least_value_is) {
  const std::vector<Chart> charts = campaign_figures(example())[1].charts;
  for (const Chart& chart : charts) {
    // The smallest value of the example, 1e-9, or the decade below it if its mean is rounded.
    EXPECT_LE(chart.least_x, 1.0001e-9) << chart.title;
    EXPECT_GE(chart.least_x, 0.9999e-10) << chart.title;
  }
}

TEST(CampaignPage, has_tables_and_figures_with_texts_that_are_escaped) {
  const std::string page = campaign_page(example());
  EXPECT_EQ(testing::tag_problem(page.substr(page.find("<html"))), "");
  EXPECT_TRUE(testing::contains(page, "1: often &lt;b&gt;"));
  EXPECT_FALSE(testing::contains(page, "often <b>"));
  EXPECT_TRUE(testing::contains(page, "1 − 0"));
  EXPECT_EQ(testing::occurrences(page, "<figure"), 4 + 2)
      << "of one pair of variants there is a table";
}

TEST(CampaignPage, links_existing_files_of_the_worst_episodes_and_says_how_to_make_the_rest) {
  CampaignStatistics statistics = example();
  EXPECT_FALSE(testing::contains(campaign_page(statistics), "The worst episodes"));
  ListedEpisode made{.page = "episodes/1/7/report.html",
                     .video = "episodes/1/7/episode.mp4",
                     .trace = "episodes/1/7/a<b.h5"};
  made.row.variant = 1;
  made.row.seed = 7;
  made.row.outcome = "fault";
  made.row.unsafe = true;
  made.row.min_clearance = -0.25;
  ListedEpisode bare{.commands = {"qsmpc run variants/0.yaml --seed 12 --out <x>"}};
  bare.row.seed = 12;
  bare.row.min_clearance = std::numeric_limits<double>::quiet_NaN();
  const std::string page = campaign_page(statistics, {made, bare});
  EXPECT_EQ(testing::tag_problem(page.substr(page.find("<html"))), "");
  EXPECT_TRUE(testing::contains(page, "<a href=\"./episodes/1/7/report.html\">page</a> · "));
  EXPECT_TRUE(testing::contains(page, "<a href=\"./episodes/1/7/episode.mp4\">video</a>"));
  EXPECT_TRUE(testing::contains(page, "<a href=\"./episodes/1/7/a%3Cb.h5\">trace</a>"));
  EXPECT_TRUE(testing::contains(page, "<th scope=\"row\">1: often &lt;b&gt;</th><td>7</td>"));
  EXPECT_TRUE(testing::contains(page, "<td>−0.25</td>"));
  EXPECT_TRUE(testing::contains(page, "--seed 12 --out &lt;x&gt;</code>"));
  EXPECT_FALSE(testing::contains(page, "nan"));
  EXPECT_EQ(testing::occurrences(page, "role=\"region\" tabindex=\"0\""),
            testing::occurrences(page, "<table"));
}

/// 40 drives: 9 reached the target, 2 left the bounds, 1 faulted, 28 collided.
VariantStatistics crashing_variant() {
  VariantTally tally;
  for (int n = 0; n < 40; ++n) {
    EpisodeRow row;
    row.outcome = n < 9 ? "reached" : n < 11 ? "left_bounds" : n < 12 ? "fault" : "collision";
    row.unsafe = n >= 9 && n != 11;
    tally.add(row);
    tally.add(0, {.certified = 1.0, .published = 1.0, .unsafe = row.unsafe});
  }
  VariantStatistics statistics = tally.result();
  statistics.name = "blind";
  return statistics;
}

CampaignStatistics crashing_campaign() {
  CampaignStatistics statistics;
  statistics.variants = {variant("sound", 2000), crashing_variant()};
  statistics.variants[1].id = 1;
  statistics.calibration = statistics.variants[1].calibration;
  statistics.published = statistics.variants[1].published;
  return statistics;
}

TEST(CampaignPage, says_first_how_many_drives_were_unsafe_and_certificates_after_that) {
  const CampaignStatistics statistics = crashing_campaign();
  const std::string page = campaign_page(statistics);
  EXPECT_EQ(testing::tag_problem(page.substr(page.find("<html"))), "");
  const std::size_t verdict = page.find(
      "<div class=\"outcome bad\"><span class=\"badge\">✕ 2.88 % of 1040 drives were unsafe; 97 % "
      "reached the target safely</span>");
  ASSERT_NE(verdict, std::string::npos);
  EXPECT_TRUE(testing::contains(page,
                                "<p>1009 reached the target, 28 collided, 2 left the bounds, 0 ran "
                                "out of time, 1 faulted.</p>"));
  EXPECT_TRUE(testing::contains(page, "Most often in variant 1: 75 % of its drives (blind).</p>"));
  // Its certificates hold, which is not good news about the drives.
  const std::size_t tick = page.find("✓ No certificate is refuted");
  ASSERT_NE(tick, std::string::npos);
  EXPECT_EQ(page.find("✓"), tick);
  EXPECT_LT(verdict, page.find("What became of the drives"));
  EXPECT_LT(page.find("What became of the drives"), page.find("Certificates of the next step"));
  EXPECT_LT(page.find("Certificates of the next step"), tick);
  EXPECT_TRUE(testing::contains(page, "This concerns the certificates only"));
}

TEST(CampaignPage, has_a_bar_of_all_drives_and_the_rates_of_each_variant) {
  const std::string page = campaign_page(crashing_campaign());
  EXPECT_EQ(testing::occurrences(page, "<svg class=\"bar\""), 2);
  EXPECT_TRUE(testing::contains(
      page,
      "<rect class=\"fill-collision\" x=\"22.500\" y=\"0\" width=\"70.000\" height=\"10\">"
      "<title>collision 70 %</title>"));
  EXPECT_TRUE(testing::contains(
      page, "aria-label=\"reached 22.5 %, collision 70 %, left bounds 5 %, fault 2.5 %\""));
  const RateInterval limits = clopper_pearson(28, 40, 0.005);
  EXPECT_TRUE(testing::contains(
      page, "<strong class=\"alarm\">70 %</strong><br/><span class=\"soft\">[" +
                format_percent(limits.lower) + ", " + format_percent(limits.upper) + "]</span>"));
  EXPECT_FALSE(testing::contains(page, "Left safe set"));
}

TEST(CampaignPage, shows_the_old_outcome_name_where_a_store_has_it) {
  CampaignStatistics statistics = crashing_campaign();
  VariantTally tally;
  tally.add({.outcome = "left_safe_set", .unsafe = true});
  statistics.variants[0] = tally.result();
  const std::string page = campaign_page(statistics);
  EXPECT_TRUE(
      testing::contains(page, "Left safe set: either of the two, in drives of an earlier version"));
  EXPECT_TRUE(testing::contains(page, "<rect class=\"fill-left_safe_set\" x=\"0.000\""));
}

TEST(OutcomeVerdict, is_good_only_where_every_drive_arrived_safely) {
  const auto mood_of = [](const std::string& outcome, bool unsafe) {
    VariantTally tally;
    for (int n = 0; n < 5; ++n) tally.add({.outcome = "reached"});
    tally.add({.outcome = outcome, .unsafe = unsafe});
    CampaignStatistics statistics;
    statistics.variants = {tally.result()};
    return outcome_verdict(statistics).mood;
  };
  EXPECT_EQ(mood_of("reached", false), PageMood::kGood);
  EXPECT_EQ(mood_of("timeout", false), PageMood::kOpen);
  EXPECT_EQ(mood_of("fault", false), PageMood::kOpen);
  EXPECT_EQ(mood_of("fault", true), PageMood::kBad);
  EXPECT_EQ(mood_of("collision", true), PageMood::kBad);
  EXPECT_EQ(mood_of("left_bounds", true), PageMood::kBad);
  CampaignStatistics none;
  none.variants = {VariantTally().result()};
  EXPECT_EQ(outcome_verdict(none).mood, PageMood::kOpen);
}

TEST(OutcomeFigure, has_a_series_of_every_way_to_fail) {
  const Chart failed = campaign_figures(crashing_campaign())[0].charts[1];
  ASSERT_EQ(failed.series.size(), 4U);
  const Series* collision = series_of(failed, "collision");
  ASSERT_NE(collision, nullptr);
  EXPECT_DOUBLE_EQ(collision->y[1], 0.7);
  EXPECT_DOUBLE_EQ(series_of(failed, "left bounds")->y[1], 0.05);
  EXPECT_NE(series_of(failed, "timeout"), nullptr);
  EXPECT_NE(series_of(failed, "fault"), nullptr);
}

TEST(CampaignPage, says_whether_a_certificate_is_refuted) {
  EXPECT_TRUE(testing::contains(campaign_page(example()), "Certificates are exceeded"));
  CampaignStatistics sound = example();
  sound.variants = {variant("seldom", 2000)};
  sound.calibration = sound.variants[0].calibration;
  sound.differences.clear();
  const std::string page = campaign_page(sound);
  EXPECT_TRUE(testing::contains(page, "No certificate is refuted"));
  EXPECT_TRUE(testing::contains(
      page, "<p>1 of 2000 periods ended unsafe; their certificates add up to 1 (p = "));
  EXPECT_FALSE(testing::contains(page, "Differences"));
}

TEST(ErrorBars, reach_from_end_to_end_and_widen_the_axis) {
  Chart chart{.title = "Rates",
              .x_label = "variant",
              .y_label = "rate (–)",
              .series = {{.name = "rate",
                          .mark = Mark::kPoints,
                          .x = {1, 2},
                          .y = {0.5, 0.5},
                          .lower = {0.0, 0.4},
                          .upper = {1.0, 0.6}}}};
  const std::string svg = chart_drawing(chart);
  const PlotFrame frame = frame_of(chart);
  EXPECT_NEAR(frame.up(0.0), kChartHeight - kChartBottom, 0.5) << "from foot";
  EXPECT_NEAR(frame.up(1.0), kChartTop, 0.5) << "to top";
  for (const std::size_t i : {0, 1}) {
    const Series& series = chart.series[0];
    const std::string bar =
        fmt::format("M{:.1f} {:.1f}h6m-3 0V{:.1f}m-3 0h6", frame.across(series.x[i]) - 3.0,
                    frame.up(series.lower[i]), frame.up(series.upper[i]));
    EXPECT_TRUE(testing::contains(svg, bar)) << bar;
  }
  chart.series[0].upper[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(testing::contains(chart_drawing(chart), "nan"));
  EXPECT_EQ(testing::occurrences(chart_drawing(chart), "h6m-3 0V"), 1);
}

TEST(LogarithmicAxis, may_be_the_one_across) {
  const Chart chart{.title = "Decades",
                    .x_label = "probability (–)",
                    .y_label = "value (–)",
                    .x_scale = Scale::kLog,
                    .series = {{.name = "line", .x = {1e-4, 1e-2, 1.0}, .y = {0, 1, 2}}}};
  const std::string svg = chart_drawing(chart);
  EXPECT_TRUE(testing::contains(svg, ">10⁻²<"));
  const PlotFrame frame = frame_of(chart);
  EXPECT_NEAR(frame.across(1e-2), 0.5 * (frame.across(1e-4) + frame.across(1.0)), 1e-9);
  EXPECT_TRUE(testing::contains(svg, fmt::format("L{:.1f} ", frame.across(1e-2))));
}

}  // namespace campaign_charts_test
}  // namespace qsmpc::harness
