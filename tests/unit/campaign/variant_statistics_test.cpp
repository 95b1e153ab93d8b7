#include "harness/campaign/statistics/variant_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "harness/campaign/statistics/variant_pairs.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace variant_statistics_test {

EpisodeRow row(const std::string& outcome, double cost, double clearance) {
  EpisodeRow result;
  result.outcome = outcome;
  result.cost = cost;
  result.min_clearance = clearance;
  result.unsafe = clearance <= 0.0;
  if (outcome == "reached") result.time_to_target = cost / 10.0;
  result.timing.deadline_misses = 2;
  return result;
}

Spread spread_of(const SpreadTally& tally, std::vector<double> values) {
  std::ranges::sort(values);
  return tally.result([&](const std::function<void(double)>& visit) {
    for (const double value : values) visit(value);
  });
}

TEST(VariantTally, counts_every_episode_also_one_that_faulted) {
  VariantTally tally;
  for (int n = 0; n < 7; ++n) tally.add(row("reached", 10.0, 0.2));
  tally.add(row("collision", 5.0, -0.1));
  tally.add(row("timeout", 30.0, 0.1));
  tally.add(row("fault", 2.0, 0.4));
  const VariantStatistics statistics = tally.result();
  EXPECT_EQ(statistics.done, 10);
  EXPECT_EQ(statistics.outcomes.at("fault"), 1);
  EXPECT_DOUBLE_EQ(statistics.reached.rate, 0.7);
  EXPECT_EQ(statistics.reached.interval.lower, clopper_pearson(7, 10, 0.005).lower);
  EXPECT_DOUBLE_EQ(statistics.unsafe.rate, 0.1);
  EXPECT_DOUBLE_EQ(statistics.fault.rate, 0.1);
  EXPECT_EQ(statistics.fault.events, 1);
  EXPECT_EQ(statistics.deadline_misses, 20);
}

TEST(VariantTally, has_a_rate_with_limits_of_each_outcome) {
  VariantTally tally;
  for (const char* outcome : {"reached", "collision", "collision", "collision", "left_bounds",
                              "left_bounds", "timeout", "timeout", "timeout", "timeout"}) {
    tally.add(row(outcome, 1.0, 0.1));
  }
  const VariantStatistics statistics = tally.result();
  EXPECT_DOUBLE_EQ(statistics.collision.rate, 0.3);
  EXPECT_EQ(statistics.collision.interval.lower, clopper_pearson(3, 10, 0.005).lower);
  EXPECT_DOUBLE_EQ(statistics.left_bounds.rate, 0.2);
  EXPECT_EQ(statistics.left_bounds.interval.upper, clopper_pearson(2, 10, 0.005).upper);
  EXPECT_DOUBLE_EQ(statistics.timeout.rate, 0.4);
  EXPECT_EQ(statistics.fault.events, 0);
}

TEST(ListedOutcomes, have_the_old_outcome_name_only_where_needed) {
  VariantTally tally;
  for (const std::string& outcome : outcome_names()) tally.add(row(outcome, 1.0, 0.1));
  std::vector<VariantStatistics> variants = {tally.result()};
  ASSERT_EQ(listed_outcomes().size() + 1, outcome_names().size()) << "none is interrupted";
  for (std::size_t n = 0; n < listed_outcomes().size(); ++n) {
    EXPECT_EQ(listed_outcomes()[n].name, outcome_names()[n]);
    EXPECT_EQ((variants[0].*listed_outcomes()[n].rate).events, 1) << n;
  }
  EXPECT_EQ(outcomes_of(variants).size(), listed_outcomes().size());
  tally.add(row("left_safe_set", 1.0, -0.1));
  variants.push_back(tally.result());
  ASSERT_EQ(outcomes_of(variants).size(), listed_outcomes().size() + 1);
  EXPECT_EQ((variants[1].*outcomes_of(variants).back().rate).events, 1);
}

TEST(VariantTally, of_nothing_knows_nothing) {
  const VariantStatistics statistics = VariantTally().result();
  EXPECT_TRUE(std::isnan(statistics.reached.rate));
  EXPECT_EQ(statistics.reached.interval.upper, 1.0);
  EXPECT_TRUE(std::isnan(statistics.unsafe_step_rate()));
  EXPECT_EQ(statistics.p_value, 1.0);
  const Spread cost = spread_of(VariantTally().cost(), {});
  EXPECT_TRUE(std::isnan(cost.mean));
  for (const double quantile : cost.quantiles) EXPECT_TRUE(std::isnan(quantile));
}

TEST(VariantTally, an_episode_that_faulted_ranks_as_the_worst_of_all) {
  VariantTally tally;
  for (const double cost : {30.0, 10.0, 20.0}) tally.add(row("reached", cost, cost / 100.0));
  tally.add(row("fault", 1.0, 0.9));
  const Spread cost = spread_of(tally.cost(), {10.0, 20.0, 30.0});
  EXPECT_EQ(cost.count, 3);
  EXPECT_EQ(cost.worst, 1);
  EXPECT_DOUBLE_EQ(cost.mean, 20.0);
  EXPECT_EQ(cost.quantiles, (std::vector<double>{10, 10, 10, 20, 30, kInfinity, kInfinity}));
  const Spread clearance = spread_of(tally.min_clearance(), {0.1, 0.2, 0.3});
  EXPECT_EQ(clearance.quantiles,
            (std::vector<double>{-kInfinity, -kInfinity, -kInfinity, 0.1, 0.2, 0.3, 0.3}));
  const Spread time = spread_of(tally.time_to_target(), {1.0, 2.0, 3.0});
  EXPECT_EQ(time.count, 3);
  EXPECT_EQ(time.worst, 0);
  EXPECT_EQ(time.quantiles, (std::vector<double>{1, 1, 1, 2, 3, 3, 3}));
}

TEST(VariantTally, holds_unsafe_periods_against_what_was_certified_and_published) {
  VariantTally tally;
  tally.add(0, {.certified = 1e-3, .published = 1e-5});
  tally.add(1, {.certified = 3e-3, .published = 3e-5, .unsafe = true});
  const VariantStatistics statistics = tally.result();
  EXPECT_EQ(statistics.periods, 2);
  EXPECT_EQ(statistics.unsafe_periods, 1);
  EXPECT_DOUBLE_EQ(statistics.unsafe_step_rate(), 0.5);
  EXPECT_DOUBLE_EQ(statistics.certified_step_rate(), 2e-3);
  EXPECT_DOUBLE_EQ(statistics.p_value,
                   exceedance_p_value({{.events = 0, .certified = 4e-3}, {1, 3e-3}}));
  const auto periods_at = [](const std::vector<CalibrationBin>& bins, double probability) {
    return bins[static_cast<std::size_t>(calibration_bin(probability))].periods;
  };
  EXPECT_EQ(periods_at(statistics.calibration, 1e-3), 2);
  EXPECT_EQ(periods_at(statistics.published, 1e-3), 0);
  EXPECT_EQ(periods_at(statistics.published, 1e-5), 2);
}

TEST(VariantPairs, compare_with_the_first_of_other_settings_and_of_another_plant) {
  const auto variant = [](const char* scenario, const char* settings, const char* plant) {
    StoredVariant stored;
    stored.scenario = scenario;
    stored.settings = settings;
    stored.plant = plant;
    return stored;
  };
  const std::vector<VariantPair> pairs =
      variant_pairs({variant("a", "", ""), variant("a", "", "car"), variant("a", "fine", ""),
                     variant("a", "fine", "car"), variant("b", "fine", "car")});
  EXPECT_EQ(pairs, (std::vector<VariantPair>{{1, 0, DiffersBy::kPlant},
                                             {2, 0, DiffersBy::kSettings},
                                             {3, 1, DiffersBy::kSettings},
                                             {3, 2, DiffersBy::kPlant}}));
  EXPECT_STREQ(differs_by_name(DiffersBy::kPlant), "plant");
}

}  // namespace variant_statistics_test
}  // namespace qsmpc::harness
