#include "harness/campaign/statistics/stop_rule.hpp"

#include <algorithm>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "harness/statistics/confidence_sequence.hpp"

namespace qsmpc::harness {
namespace stop_rule_test {

constexpr std::int64_t kSeeds = 4000;
const StopCriterion common_criterion{.of = "unsafe", .rate_halfwidth = 0.03, .confidence = 0.95};

/// Whether each of two variants has an event with each seed.
std::vector<std::vector<bool>> made_events() {
  std::mt19937_64 random(11);
  std::vector<std::vector<bool>> events(2);
  for (std::int64_t i = 0; i < kSeeds; ++i) {
    events[0].push_back(std::bernoulli_distribution(0.02)(random));
    events[1].push_back(std::bernoulli_distribution(0.2)(random));
  }
  return events;
}

/// The rule's answer, found by checking every number of seeds.
std::int64_t plain_answer(const std::vector<std::vector<bool>>& events) {
  std::vector<std::int64_t> counts(events.size());
  for (std::int64_t n = 1; n <= kSeeds; ++n) {
    bool all = true;
    for (std::size_t v = 0; v < events.size(); ++v) {
      counts[v] += events[v][static_cast<std::size_t>(n - 1)] ? 1 : 0;
      const RateInterval interval = confidence_sequence(counts[v], n, common_criterion.confidence);
      all = all && interval.upper - interval.lower <= 2.0 * common_criterion.rate_halfwidth;
    }
    if (all) return n;
  }
  return -1;
}

TEST(StopRule, stops_at_the_first_number_of_seeds_at_which_every_interval_is_narrow_enough) {
  const std::vector<std::vector<bool>> events = made_events();
  StopRule rule(common_criterion, 2, kSeeds);
  const std::int64_t expected = plain_answer(events);
  ASSERT_GT(expected, 100);
  for (std::int64_t i = 0; i < kSeeds; ++i) {
    EXPECT_EQ(rule.stops_after().has_value(), i >= expected) << i;
    for (const std::size_t v : {std::size_t{0}, std::size_t{1}}) {
      rule.add(i, v, events[v][static_cast<std::size_t>(i)]);
    }
  }
  EXPECT_EQ(rule.stops_after(), expected);
  EXPECT_EQ(rule.complete(), expected);
}

TEST(StopRule, decides_the_same_in_whatever_order_episodes_arrive) {
  const std::vector<std::vector<bool>> events = made_events();
  const std::int64_t expected = plain_answer(events);
  std::vector<std::pair<std::int64_t, std::size_t>> order;
  for (std::int64_t i = 0; i < kSeeds; ++i) {
    order.emplace_back(i, 0);
    order.emplace_back(i, 1);
  }
  std::mt19937_64 random(5);
  for (int n = 0; n < 5; ++n) {
    std::ranges::shuffle(order, random);
    StopRule rule(common_criterion, 2, kSeeds);
    for (const auto& [seed, variant] : order) {
      rule.add(seed, variant, events[variant][static_cast<std::size_t>(seed)]);
    }
    EXPECT_EQ(rule.stops_after(), expected);
  }
}

TEST(StopRule, waits_for_a_seed_that_is_missing_whatever_is_known_of_later_ones) {
  StopRule rule({.rate_halfwidth = 0.25, .confidence = 0.9}, 1, kSeeds);
  for (std::int64_t i = 0; i < kSeeds; ++i) {
    if (i != 2) rule.add(i, 0, false);
  }
  EXPECT_EQ(rule.complete(), 2);
  EXPECT_FALSE(rule.stops_after());
  rule.add(2, 0, false);
  ASSERT_TRUE(rule.stops_after());
  const std::int64_t stop = *rule.stops_after();
  EXPECT_LE(confidence_sequence(0, stop, 0.9).upper, 0.5);
  EXPECT_GT(confidence_sequence(0, stop - 1, 0.9).upper, 0.5);
}

TEST(StopRule, an_episode_that_is_reported_twice_counts_once) {
  StopRule rule(common_criterion, 1, kSeeds);
  rule.add(0, 0, true);
  rule.add(1, 0, true);
  rule.add(0, 0, true);
  rule.add(1, 0, true);
  EXPECT_EQ(rule.complete(), 2);
  EXPECT_EQ(rule.interval(0).lower, confidence_sequence(2, 2, common_criterion.confidence).lower);
}

TEST(StopRule, does_not_stop_where_all_seeds_are_too_few) {
  StopRule rule({.rate_halfwidth = 0.001}, 1, 10);
  for (std::int64_t i = 0; i < 10; ++i) rule.add(i, 0, false);
  EXPECT_EQ(rule.complete(), 10);
  EXPECT_FALSE(rule.stops_after());
}

TEST(StopRule, refuses_unknown_seeds_and_variants) {
  EXPECT_THROW(StopRule(common_criterion, 0, 5), std::invalid_argument);
  StopRule rule(common_criterion, 2, 5);
  EXPECT_THROW(rule.add(5, 0, false), std::invalid_argument);
  EXPECT_THROW(rule.add(-1, 0, false), std::invalid_argument);
  EXPECT_THROW(rule.add(0, 2, false), std::invalid_argument);
}

TEST(StopRule, counts_what_the_criterion_names) {
  EXPECT_TRUE(is_stop_event({.of = "unsafe"}, "timeout", true));
  EXPECT_FALSE(is_stop_event({.of = "unsafe"}, "timeout", false));
  EXPECT_TRUE(is_stop_event({.of = "timeout"}, "timeout", true));
  EXPECT_FALSE(is_stop_event({.of = "reached"}, "timeout", false));
}

}  // namespace stop_rule_test
}  // namespace qsmpc::harness
