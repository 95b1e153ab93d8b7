// The comparison of controllers drawn from a contest's drives, and its wording.
#include "harness/contest/standings.hpp"

#include <cmath>
#include <filesystem>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/contest/contest_results.hpp"
#include "harness/contest/sentences.hpp"
#include "harness/report/contest_charts.hpp"
#include "harness/report/contest_page.hpp"
#include "harness/statistics/binomial_interval.hpp"
#include "harness/statistics/sign_test.hpp"
#include "tests/unit/contest/contest_fixture.hpp"
#include "tests/unit/report/page_checks.hpp"

namespace qsmpc::harness {
namespace standings_test {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kSeeds = 40;

EpisodeRow drive(std::int64_t variant, std::uint64_t seed, const std::string& outcome,
                 double cost) {
  EpisodeRow row = testing::example_row(variant, seed, outcome);
  row.unsafe = outcome == "collision" || outcome == "left_bounds";
  row.cost = cost;
  row.believed_max.reset();
  row.believed_sum.reset();
  row.periods = {{.certified = 1e-3, .ocp_ms = 4.0 + static_cast<double>(variant)}};
  return row;
}

/// Two noises. `careful` always arrives; `bold` costs a tenth less, and collides on twelve seeds in
/// the first cell and on the same twelve in the second; the costs of those drives do not count.
class Standings : public ::testing::Test {
 protected:
  /// Sum of `careful`'s certificates: above 0.02 on four seeds of the first cell, no number on one
  /// of the second, else 0.02.
  static double certified(std::int64_t cell, std::uint64_t seed) {
    if (cell == 0) return seed < 4 ? 0.03 : 0.02;
    return seed == 4 ? std::nan("") : 0.02;
  }

  Standings() {
    std::vector<EpisodeRow> rows;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const bool hits = seed < 12;
      for (const std::int64_t cell : {0, 1}) {
        const double cost = (cell == 0 ? 100.0 : 1000.0) * (1.0 + 0.01 * static_cast<double>(seed));
        rows.push_back(drive(cell, seed, "reached", cost));
        rows.back().believed_sum = 0.25;
        rows.back().believed_max = 0.25;
        rows.back().next_step_sum = certified(cell, seed);
        // No plans on three seeds, one above 0.02 on the next two.
        rows.back().horizon_max = seed < 3 ? std::nan("") : seed < 5 ? 0.021 : 0.02;
        rows.push_back(
            drive(2 + cell, seed, hits ? "collision" : "reached", hits ? 1.0 : 0.9 * cost));
        rows.back().next_step_sum = 0.001;
      }
    }
    fill("drives", loaded_.drives, rows);
    std::vector<EpisodeRow> timed;
    for (const std::int64_t variant : {0, 1, 2, 3}) {
      timed.push_back(drive(variant, 0, "reached", 1.0));
    }
    fill("timing", timed_drives(loaded_.contest, {0, 0}), timed);
  }
  void fill(const std::string& name, const Campaign& campaign,
            const std::vector<EpisodeRow>& rows) const {
    std::filesystem::create_directory(folder_.path(name));
    testing::fill_store(campaign, folder_.path(name), rows);
  }
  [[nodiscard]] ContestResults results(bool with_times = true) const {
    const StoreReader drives(folder_.path("drives"));
    const StoreReader timed(folder_.path("timing"));
    return contest_results(loaded_.contest, untuned(loaded_.contest), drives,
                           with_times ? &timed : nullptr);
  }

  testing::ContestFolder folder_;
  LoadedContest loaded_ = folder_.load(
      "controllers:\n  careful: {controller.kind: quantised}\n  \"<bold>\": {controller.kind: "
      "lqr}\n"
      "scenarios: [quick.yaml]\nseeds: {count: 40}\nnoise: [1, 2]\ntiming: {seeds: 1}\n");
};

TEST_F(Standings, of_a_cell_have_the_limits_of_its_drives) {
  const ContestResults all = results();
  ASSERT_EQ(all.cells.size(), 2U);
  EXPECT_EQ(all.done, 4 * kSeeds);
  EXPECT_EQ(all.asked, 4 * kSeeds);
  EXPECT_EQ(all.cells[0].name, "noise 1");
  const Standing& bold = all.cells[0].standings[1];
  EXPECT_EQ(bold.drives, kSeeds);
  EXPECT_EQ(bold.collision.events, 12);
  EXPECT_EQ(bold.collision.rate, 0.3);
  EXPECT_EQ(bold.unsafe.interval.upper, clopper_pearson(12, kSeeds, 0.005).upper);
  EXPECT_EQ(bold.unsafe.interval.lower, clopper_pearson(12, kSeeds, 0.005).lower);
  EXPECT_EQ(bold.reached.events, 28);
  EXPECT_EQ(bold.cost.drives, 28);
  EXPECT_EQ(bold.believed.drives, 0);
  EXPECT_EQ(all.cells[0].standings[0].believed.mean, 0.25);
}

TEST_F(Standings, over_all_cells_take_the_seeds_for_independent_and_not_the_drives) {
  const ContestResults all = results();
  const Standing& bold = all.overall[1];
  EXPECT_EQ(bold.drives, 2 * kSeeds);
  EXPECT_EQ(bold.collision.events, 24);
  EXPECT_EQ(bold.collision.rate, 0.3);
  EXPECT_EQ(bold.unsafe.interval.upper, clopper_pearson(12, kSeeds, 0.005).upper);
  EXPECT_TRUE(std::isnan(bold.cost.mean)) << "costs of different cells do not add up";
}

TEST_F(Standings, compare_the_costs_of_drives_that_both_arrive) {
  const ContestResults all = results();
  const Versus& versus = *all.overall[1].versus;
  EXPECT_EQ(versus.cost.pairs, 2 * 28);
  EXPECT_NEAR(versus.cost.ratio, 0.9, 1e-12);
  // Every pair has the same ratio, and so has every replicate, up to rounding.
  EXPECT_NEAR(versus.cost.ratio_interval.lower, 0.9, 1e-12);
  EXPECT_NEAR(versus.cost.ratio_interval.upper, 0.9, 1e-12);
  EXPECT_EQ(versus.economy(), MatchResult::kWin);
  EXPECT_FALSE(all.overall[0].versus) << "the reference is not compared with itself";
}

TEST_F(Standings, count_each_seed_once_in_the_sign_test) {
  const ContestResults all = results();
  const Versus& versus = *all.overall[1].versus;
  EXPECT_EQ(versus.unsafe.pairs, 2 * kSeeds);
  EXPECT_EQ(versus.unsafe.higher, 12);
  EXPECT_EQ(versus.unsafe.lower, 0);
  EXPECT_DOUBLE_EQ(versus.unsafe.p_value, sign_test_p_value(12, 0));
  EXPECT_DOUBLE_EQ(versus.unsafe.mean, 0.3);
  EXPECT_EQ(versus.safety(), MatchResult::kLoss);
  EXPECT_EQ(versus.arrival(), MatchResult::kLoss);
  const CellCounts counts = cell_counts(all, 1, &Versus::safety);
  EXPECT_EQ(counts.losses, 2);
  EXPECT_EQ(counts.wins + counts.ties, 0);
}

TEST_F(Standings, keep_a_risk_limit_where_they_arrive_and_are_certified_within_it) {
  EXPECT_FALSE(results().overall[0].kept) << "no limit is asked";
  loaded_.contest.risk_limit = 0.02;
  const ContestResults all = results();
  ASSERT_TRUE(all.overall[0].kept);
  EXPECT_EQ(all.cells[0].standings[0].kept->events, 36);
  EXPECT_EQ(all.cells[1].standings[0].kept->events, 39) << "a sum that is no number is not kept";
  EXPECT_EQ(all.overall[0].kept->events, 75);
  EXPECT_EQ(all.overall[1].kept->events, 56) << "those that collide do not keep it";
  EXPECT_EQ(all.overall[1].kept->interval.lower, clopper_pearson(28, kSeeds, 0.005).lower);
  EXPECT_EQ(all.overall[0].promised->events, 2 * 35);
  EXPECT_EQ(all.cells[0].standings[0].promised->interval.upper,
            clopper_pearson(35, kSeeds, 0.005).upper);
  EXPECT_THAT(words_about(all, 0), HasSubstr(", with every plan certified within it in 87.5 % ["));
  EXPECT_THAT(contest_page(all), HasSubstr(">87.5 %</td>"));
  EXPECT_THAT(words_about(all, 0), HasSubstr("; arrives within a certified risk of 0.02"));
  EXPECT_THAT(words_about(all, 1), HasSubstr(" in 70 % of its drives ["));
  EXPECT_THAT(contest_table(all), HasSubstr("  93.8 "));
  EXPECT_THAT(contest_table(all), HasSubstr("certified at most 0.02 in total"));
  const std::string page = contest_page(all);
  EXPECT_EQ(testing::tag_problem(page), "");
  EXPECT_THAT(page, HasSubstr(">kept</th>"));
  EXPECT_THAT(page, HasSubstr(">93.8 %</td>"));
  loaded_.contest.risk_limit = 0.0005;
  EXPECT_EQ(results().overall[1].kept->events, 0);
}

TEST_F(Standings, without_significance_are_ties) {
  Versus versus;
  versus.unsafe = {.pairs = 99, .higher = 6, .lower = 0, .p_value = sign_test_p_value(6, 0)};
  versus.cost = {.pairs = kFewestPairs - 1, .ratio = 0.5, .ratio_interval = {0.4, 0.6}};
  EXPECT_EQ(versus.safety(), MatchResult::kTie) << "6 to 0 has p = 0.03";
  EXPECT_EQ(versus.economy(), MatchResult::kTie) << "too few pairs for a bootstrap";
  versus.cost.pairs = kFewestPairs;
  EXPECT_EQ(versus.economy(), MatchResult::kWin);
  versus.cost.ratio_interval = {0.9, 1.1};
  EXPECT_EQ(versus.economy(), MatchResult::kTie);
  versus.cost.ratio_interval = {1.01, 1.1};
  EXPECT_EQ(versus.economy(), MatchResult::kLoss);
}

TEST_F(Standings, have_the_times_of_the_timed_drives_alone) {
  EXPECT_EQ(results().cells[1].standings[1].times.ocp_ms.median, 7.0);
  EXPECT_EQ(results().overall[1].times.periods, 2);
  EXPECT_EQ(results().overall[1].times.ocp_ms.max, 7.0);
  EXPECT_EQ(results(false).overall[1].times.periods, 0);
}

TEST_F(Standings, are_described_in_words_that_the_numbers_bear_out) {
  const ContestResults all = results();
  EXPECT_EQ(contest_headline(all),
            "Fewest unsafe drives: careful (0 %). Cheapest where both arrive: <bold>, 10 % below "
            "careful.");
  EXPECT_EQ(
      words_about(all, 1),
      "Less safe than careful: 30 % of its drives unsafe against 0 % (p < 0.001); arrives less "
      "often (70 % against 100 %, p < 0.001); where both arrive, cheaper (−10 % [−10, −10]); no "
      "estimate of its risk. Wins–ties–losses of 2: safety 0–0–2, arrival 0–0–2, cost 2–0–0.");
  EXPECT_EQ(words_about(all, 0),
            "The reference: 100 % of its drives arrive, 0 % [0, 12.4] are unsafe; overestimates "
            "its risk (expected 0.25 unsafe periods per drive).");
}

TEST_F(Standings, that_differ_by_chance_are_reported_as_ties) {
  ContestResults all = results();
  Versus& versus = *all.overall[1].versus;
  versus.unsafe.p_value = 0.5;
  versus.reached.p_value = 0.5;
  versus.cost.ratio_interval = {.lower = 0.8, .upper = 1.05};
  all.overall[1].believed = {.drives = 80, .mean = 0.001};
  EXPECT_THAT(
      words_about(all, 1),
      HasSubstr("No significant difference in safety from careful in these drives: 30 % of its "
                "drives unsafe against 0 % (p = 0.5); where both arrive, no significant difference "
                "in cost (−10 % [−20, 5]); underestimates its risk (expected 0.001 unsafe periods "
                "per drive)."));
  versus.cost.pairs = 3;
  EXPECT_THAT(words_about(all, 1), HasSubstr("; too few drives on which both arrive"));
}

TEST_F(Standings, are_on_the_page_with_names_as_text) {
  const std::string page = contest_page(results());
  EXPECT_EQ(testing::tag_problem(page), "");
  EXPECT_THAT(page, HasSubstr("&lt;bold&gt;"));
  EXPECT_THAT(page, Not(HasSubstr("<bold>")));
  EXPECT_THAT(page, HasSubstr("30 %</strong>"));
  EXPECT_THAT(page, HasSubstr("<a href=\"./report.html\">"));
  EXPECT_EQ(contest_charts(results()).size(), 3U) << "over all, and of each cell";
}

TEST_F(Standings, have_no_figure_of_a_cell_in_which_nobody_arrives) {
  ContestResults all = results();
  const auto strand = [](Standing& standing) {
    standing.reached = episode_rate(0, standing.drives);
    standing.cost.mean = std::nan("");
  };
  for (Standing& standing : all.cells[1].standings) strand(standing);
  EXPECT_EQ(contest_charts(all).size(), 2U);
  for (Standing& standing : all.cells[0].standings) strand(standing);
  for (Standing& standing : all.overall) strand(standing);
  EXPECT_TRUE(contest_charts(all).empty());
  const std::string page = contest_page(all);
  EXPECT_EQ(testing::tag_problem(page), "");
  EXPECT_THAT(page, HasSubstr("there is no cost to draw"));
  EXPECT_THAT(page, Not(HasSubstr("<svg class=\"chart")));
}

TEST_F(Standings, are_the_same_in_json_and_csv) {
  EXPECT_EQ(nlohmann::json::parse(contest_json(results()))["risk_limit"], nullptr);
  const std::string without = contest_csv(results());
  loaded_.contest.risk_limit = 0.02;
  const ContestResults all = results();
  const auto json = nlohmann::json::parse(contest_json(all));
  EXPECT_EQ(json["cells"].size(), 2U);
  EXPECT_EQ(json["cells"][1]["noise"], 2.0);
  const auto& bold = json["controllers"]["<bold>"]["overall"];
  EXPECT_EQ(bold["unsafe"]["rate"], 0.3);
  EXPECT_EQ(bold["versus"]["unsafe"]["result"], "loss");
  EXPECT_EQ(bold["ocp_ms"]["max"], 7.0);
  EXPECT_EQ(json["controllers"]["careful"]["overall"]["versus"], nullptr);
  EXPECT_EQ(json["risk_limit"], 0.02);
  EXPECT_EQ(bold["kept"]["drives"], 56);
  EXPECT_EQ(bold["kept"]["rate"], 0.7);
  EXPECT_EQ(json["controllers"]["careful"]["overall"]["promised"]["drives"], 70);
  std::istringstream lines(contest_csv(all));
  std::string head;
  std::getline(lines, head);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    EXPECT_EQ(std::ranges::count(line, ','), std::ranges::count(head, ',')) << line;
  }
  EXPECT_EQ(count, 2 + 2 * 2) << "over all, and of each cell";
  EXPECT_EQ(without.substr(0, without.find('\n')), head) << "with and without a limit";
}

TEST(SignTest, is_the_exact_binomial_one) {
  EXPECT_EQ(sign_test_p_value(0, 0), 1.0);
  EXPECT_EQ(sign_test_p_value(3, 3), 1.0);
  EXPECT_DOUBLE_EQ(sign_test_p_value(8, 0), 2.0 / 256.0);
  EXPECT_DOUBLE_EQ(sign_test_p_value(1, 9), 2.0 * 11.0 / 1024.0);
  EXPECT_THROW((void)sign_test_p_value(-1, 2), std::invalid_argument);
}

}  // namespace standings_test
}  // namespace qsmpc::harness
