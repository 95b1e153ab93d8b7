// Valid contents of a contest file, and what is refused.
#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/contest/contest_fixture.hpp"

namespace qsmpc::harness {
namespace contest_reader_test {

using testing::contest_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const testing::ContestFolder& folder() {
  static const testing::ContestFolder made;
  return made;
}

TEST(ContestFile, has_defaults_for_all_that_it_leaves_out) {
  const Contest contest = folder().load(contest_text()).contest;
  EXPECT_EQ(contest.name, "small");
  EXPECT_EQ(contest.reference, 0U);
  EXPECT_THAT(contest.noise, ElementsAre(1.0));
  ASSERT_EQ(contest.plants.size(), 1U);
  EXPECT_EQ(contest.plants[0].text, "");
  EXPECT_FALSE(contest.tuning);
  EXPECT_EQ(contest.timing_seeds, 3);
  EXPECT_FALSE(contest.risk_limit);
  EXPECT_EQ(contest.cells().size(), 1U);
}

TEST(ContestFile, is_read_with_all_of_its_keys) {
  const LoadedContest loaded = folder().load(contest_text(
      "name: all\ndescription: of it\nreference: bold\nnoise: [1, 2]\nplants: [analytic]\n"
      "common: {limit.steps: 2}\ntiming: {seeds: 1}\nrisk_limit: 0.02\n"
      "tuning: {seeds: [1, 2], budget: 3, search: {careful: {controller.max_iterations: [3, "
      "4]}}}\n"));
  const Contest& contest = loaded.contest;
  EXPECT_EQ(contest.name, "all");
  EXPECT_EQ(contest.reference, 1U);
  EXPECT_EQ(contest.timing_seeds, 1);
  EXPECT_EQ(contest.risk_limit, 0.02);
  ASSERT_TRUE(contest.tuning);
  EXPECT_EQ(contest.tuning->budget, 3);
  EXPECT_EQ(contest.controllers[0].grid, 2);
  EXPECT_EQ(contest.controllers[0].candidates[1].label, "controller.max_iterations=4");
  EXPECT_EQ(loaded.drives.variants.size(), 4U);
  EXPECT_EQ(loaded.search.variants.size(), 4U)
      << "two candidates with two noises; one has no choice";
  EXPECT_EQ(loaded.search.seeds.listed, (std::vector<std::uint64_t>{1, 2}));
  EXPECT_EQ(loaded.drives.variants[0].resolved.step_limit, 2);
}

TEST(ContestFile, controllers_may_not_differ_in_the_problem) {
  for (const std::string key :
       {"controller.horizon", "controller.cost.state", "controller.deadline", "controller.threads",
        "controller.input_bounds"}) {
    EXPECT_THAT(folder().problems("controllers:\n  a: {" + key +
                                  ": 1}\n  b: {}\n"
                                  "scenarios: [quick.yaml]\nseeds: [1]\n"),
                HasSubstr("small.yaml:2: controllers.a." + key + ": found " + key +
                          ", expected the same for all controllers, in common"));
  }
  for (const std::string key : {"disturbance.covariance", "limit.steps", "controller"}) {
    EXPECT_THAT(folder().problems("controllers:\n  a: {" + key +
                                  ": 1}\n  b: {}\n"
                                  "scenarios: [quick.yaml]\nseeds: [1]\n"),
                HasSubstr("expected keys within controller or risk"))
        << key;
  }
  EXPECT_THAT(
      folder().problems(contest_text(
          "tuning: {seeds: [1], budget: 2, search: {bold: {controller.horizon: [2, 3]}}}\n")),
      HasSubstr("small.yaml:6: tuning.search.bold.controller.horizon.0: found "
                "controller.horizon, expected the same for all"));
}

TEST(ContestFile, seeds_of_the_search_differ_from_those_of_the_contest) {
  const auto tuned_on = [](const std::string& seeds, const std::string& drives) {
    return folder().problems(
        "controllers: {a: {}, b: {}}\nscenarios: [quick.yaml]\nseeds: " + drives +
        "\ntuning:\n  seeds: " + seeds + "\n  budget: 1\n  search: {a: {risk: [{}]}}\n");
  };
  const std::string refusal = "small.yaml:5: tuning.seeds: found seed 7, one of the contest's";
  EXPECT_THAT(tuned_on("{first: 7, count: 2}", "{first: 5, count: 3}"), HasSubstr(refusal));
  EXPECT_THAT(tuned_on("[1, 7]", "{first: 5, count: 3}"), HasSubstr(refusal));
  EXPECT_THAT(tuned_on("{first: 6, count: 9}", "[1, 7]"), HasSubstr(refusal));
  EXPECT_THAT(tuned_on("[7]", "[1, 7]"), HasSubstr(refusal));
  EXPECT_EQ(tuned_on("{first: 8, count: 2}", "{first: 5, count: 3}"), "");
  EXPECT_EQ(tuned_on("[4, 8]", "{first: 5, count: 3}"), "");
}

TEST(ContestFile, that_is_wrong_is_refused_at_its_line_and_key) {
  const auto problems = [](const std::string& more) {
    return folder().problems(contest_text(more));
  };
  EXPECT_THAT(problems("reference: brave\n"), HasSubstr("small.yaml:6: reference: found brave"));
  EXPECT_THAT(problems("noise: [1, 1]\n"), HasSubstr("noise.1: found 1 a second time"));
  EXPECT_THAT(problems("noise: [-1]\n"), HasSubstr("noise.0: found -1, expected a number from 0"));
  EXPECT_THAT(problems("tuning: {seeds: [1], search: {bold: {risk: [{}]}}}\n"),
              HasSubstr("tuning.budget: found nothing"));
  EXPECT_THAT(problems("tuning: {seeds: [1], budget: 1, search: {brave: {risk: [{}]}}}\n"),
              HasSubstr("tuning.search.brave: found brave, expected one of careful, bold"));
  EXPECT_THAT(problems("risk_limit: 1.5\n"),
              HasSubstr("small.yaml:6: risk_limit: found 1.5, expected a number >= 0 and <= 1"));
  EXPECT_THAT(problems("risk_limt: 0.02\n"), HasSubstr("expected risk_limit"));
  EXPECT_THAT(problems("risk_limit: low\n"), HasSubstr("risk_limit: found low"));
  EXPECT_THAT(problems("rules: none\n"), HasSubstr("small.yaml:6: rules: found"));
  EXPECT_THAT(problems("common: {seed: 3}\n"), HasSubstr("common.seed: found a seed"));
  EXPECT_THAT(folder().problems("controllers: {a: {}}\nscenarios: [quick.yaml]\nseeds: [1]\n"),
              HasSubstr("controllers: found"));
  EXPECT_THAT(folder().problems("controllers:\n  a: {controller.kind: mpi}\n  b: {}\n"
                                "scenarios: [quick.yaml]\nseeds: [1]\n"),
              HasSubstr("small.yaml:2: controllers.a.controller.kind: found mpi"));
}

TEST(ContestFile, a_setting_that_is_made_twice_is_refused) {
  EXPECT_THAT(folder().problems("controllers:\n  a: {controller.kind: lqr}\n  b: {}\n"
                                "scenarios: [quick.yaml]\nseeds: [1]\n"
                                "tuning: {seeds: [2], budget: 2, search: {a: {controller.kind: "
                                "[lqr, nominal]}}}\n"),
              HasSubstr("controller.kind a second time"));
}

/// The candidates of a grid of 4 x 5 points with a budget.
std::vector<std::string> tried(const std::string& name, int budget) {
  const LoadedContest loaded = folder().load(
      fmt::format("controllers: {{{0}: {{}}, other: {{}}}}\nscenarios: [quick.yaml]\nseeds: [1]\n"
                  "tuning: {{seeds: [2], budget: {1}, search: {{{0}: {{controller.max_iterations: "
                  "[1, 2, 3, 4], "
                  "controller.quantisation.state: [5, 6, 7, 8, 9]}}}}}}\n",
                  name, budget));
  std::vector<std::string> labels;
  for (const ContestCandidate& candidate : loaded.contest.controllers[0].candidates) {
    labels.push_back(candidate.label);
  }
  return labels;
}

TEST(ContestSearch, tries_the_whole_grid_in_its_order_where_the_budget_allows) {
  const std::vector<std::string> all = tried("a", 20);
  ASSERT_EQ(all.size(), 20U);
  EXPECT_EQ(all[0], "controller.max_iterations=1, controller.quantisation.state=5");
  EXPECT_EQ(all[1], "controller.max_iterations=1, controller.quantisation.state=6");
  EXPECT_EQ(all[19], "controller.max_iterations=4, controller.quantisation.state=9");
  EXPECT_EQ(tried("a", 100), all);
}

TEST(ContestSearch, takes_a_fixed_part_of_a_grid_beyond_the_budget) {
  const std::vector<std::string> all = tried("a", 20);
  const std::vector<std::string> some = tried("a", 6);
  EXPECT_EQ(some.size(), 6U);
  EXPECT_EQ(std::set<std::string>(some.begin(), some.end()).size(), 6U);
  EXPECT_TRUE(std::ranges::includes(
      all, some, {},
      [&](const std::string& label) { return std::ranges::find(all, label) - all.begin(); },
      [&](const std::string& label) { return std::ranges::find(all, label) - all.begin(); }));
  EXPECT_EQ(tried("a", 6), some) << "the same every time";
  EXPECT_NE(tried("b", 6), some) << "by chance, which is the controller's own";
  EXPECT_NE(some, std::vector<std::string>(all.begin(), all.begin() + 6));
}

}  // namespace contest_reader_test
}  // namespace qsmpc::harness
