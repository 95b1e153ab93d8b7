// The candidate that the search chooses.
#include "harness/contest/tuning.hpp"

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "tests/unit/contest/contest_fixture.hpp"

namespace qsmpc::harness {
namespace tuning_test {

TEST(Tuning, fewer_failures_come_before_any_cost) {
  EXPECT_EQ(best_candidate({{.candidate = 0, .drives = 9, .failures = 2, .relative_cost = 0.5},
                            {.candidate = 1, .drives = 9, .failures = 1, .relative_cost = 2.0}}),
            1U);
}

TEST(Tuning, of_as_many_failures_the_cheapest_is_taken_and_of_equal_ones_the_first) {
  const double none = std::nan("");
  EXPECT_EQ(best_candidate({{.candidate = 3, .failures = 1, .relative_cost = 1.1},
                            {.candidate = 5, .failures = 1, .relative_cost = 0.9},
                            {.candidate = 8, .failures = 1, .relative_cost = 0.9}}),
            5U);
  EXPECT_EQ(best_candidate({{.candidate = 0, .failures = 4, .relative_cost = none},
                            {.candidate = 1, .failures = 4, .relative_cost = 7.0}}),
            1U)
      << "one that arrived once is better than one that never did";
  EXPECT_EQ(best_candidate({{.candidate = 2, .failures = 4, .relative_cost = none},
                            {.candidate = 6, .failures = 4, .relative_cost = none}}),
            2U);
}

/// A drive of the search; everything else is as in example_row.
EpisodeRow drive(std::int64_t variant, std::uint64_t seed, double cost,
                 const std::string& outcome = "reached") {
  EpisodeRow row = testing::example_row(variant, seed, outcome);
  row.cost = cost;
  row.unsafe = outcome == "collision";
  return row;
}

class TunedContest : public ::testing::Test {
 protected:
  TunedContest() {
    std::filesystem::create_directory(store_);
    testing::fill_store(
        loaded_.search, store_,
        {// Noise 1 costs ten times as much as noise 2, and must not outvote it.
         drive(0, 50, 1000.0), drive(0, 51, 1000.0), drive(1, 50, 130.0), drive(1, 51, 130.0),
         // The second candidate: 10 % more expensive in the first cell, cheaper in the other.
         drive(2, 50, 1100.0), drive(2, 51, 1100.0), drive(3, 50, 90.0), drive(3, 51, 90.0),
         // The third: the cheapest where it arrives.
         drive(4, 50, 10.0), drive(4, 51, 5.0, "collision"), drive(5, 50, 10.0),
         drive(5, 51, 10.0)});
  }
  testing::ContestFolder folder_;
  LoadedContest loaded_ = folder_.load(
      testing::contest_text("noise: [1, 2]\ntuning: {seeds: [50, 51], budget: 3, search: {bold: "
                            "{controller.max_iterations: [3, 4, 5]}}}\n"));
  std::string store_ = folder_.path("search");
};

TEST_F(TunedContest, weighs_every_cell_alike) {
  const TuningResult result = tuned(loaded_.contest, StoreReader(store_));
  EXPECT_EQ(result.choice, (ContestChoice{0, 1}));
  EXPECT_TRUE(result.tried[0].empty());
  ASSERT_EQ(result.tried[1].size(), 3U);
  EXPECT_EQ(result.tried[1][0].drives, 4);
  EXPECT_EQ(result.tried[1][2].failures, 1);
  // By cell in units of the mean over the candidates: of 1000, 1100, 10, and of 130, 90, 10.
  const double first = 2110.0 / 3.0;
  const double second = 230.0 / 3.0;
  EXPECT_DOUBLE_EQ(result.tried[1][0].relative_cost, 0.5 * (1000.0 / first + 130.0 / second));
  EXPECT_DOUBLE_EQ(result.tried[1][1].relative_cost, 0.5 * (1100.0 / first + 90.0 / second));
  EXPECT_DOUBLE_EQ(result.tried[1][2].relative_cost, 0.5 * (10.0 / first + 10.0 / second));
}

TEST_F(TunedContest, with_a_risk_limit_counts_the_drives_that_do_not_keep_it) {
  loaded_.contest.risk_limit = 0.01;
  const std::string store = folder_.path("certified");
  std::filesystem::create_directory(store);
  std::vector<EpisodeRow> rows;
  for (const std::int64_t variant : {0, 1, 2, 3, 4, 5}) {
    for (const std::uint64_t seed : {50U, 51U}) rows.push_back(drive(variant, seed, 100.0));
    // The first candidate exceeds the limit once, the last in both cells; the second is dearer.
    rows.back().next_step_sum = variant == 0 || variant >= 4 ? 0.011 : 0.01;
    rows.back().cost = variant == 2 || variant == 3 ? 300.0 : 100.0;
  }
  testing::fill_store(loaded_.search, store, rows);
  const TuningResult result = tuned(loaded_.contest, StoreReader(store));
  EXPECT_EQ(result.choice, (ContestChoice{0, 1}));
  EXPECT_EQ(result.tried[1][0].failures, 1);
  EXPECT_EQ(result.tried[1][1].failures, 0);
  EXPECT_EQ(result.tried[1][2].failures, 2);
  EXPECT_EQ(result.tried[1][0].relative_cost, result.tried[1][2].relative_cost)
      << "drives that arrive count for the cost, within the limit or not";
  EXPECT_NE(tuning_criterion(loaded_.contest).find("certified above 0.01"), std::string::npos);
}

TEST_F(TunedContest, chooses_what_the_contest_then_drives_with) {
  const Campaign drives = chosen_drives(loaded_.contest, {0, 1});
  EXPECT_EQ(drives.variants[2].settings, "bold, noise=1");
  EXPECT_EQ(drives.variants[2].resolved.controller.max_iterations, 4);
  EXPECT_EQ(drives.variants[0].resolved.controller.max_iterations,
            testing::quick_scenario().controller.max_iterations);
  EXPECT_EQ(timed_drives(loaded_.contest, {0, 1}).name, "small, timing");
}

}  // namespace tuning_test
}  // namespace qsmpc::harness
