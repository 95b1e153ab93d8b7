// A confidence sequence holds at all numbers of trials simultaneously, and therefore under
// data-dependent stopping.
#include "harness/statistics/confidence_sequence.hpp"

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace property_confidence_sequence_test {

constexpr std::int64_t kTrials = 3000;
constexpr int kRuns = 4000;
constexpr double kConfidence = 0.9;

/// The event counts in n trials that are incompatible with a probability: fewer than `least`, or
/// more than `most`.
struct Compatible {
  std::int64_t least = 0;
  std::int64_t most = 0;
};

/// For n = 0 … kTrials.
std::vector<Compatible> compatible_counts(double probability) {
  std::vector<Compatible> all(1);
  for (std::int64_t n = 1; n <= kTrials; ++n) {
    Compatible counts{.least = all.back().least, .most = all.back().most};
    while (confidence_sequence(counts.least, n, kConfidence).upper < probability) ++counts.least;
    while (counts.most < n &&
           confidence_sequence(counts.most + 1, n, kConfidence).lower <= probability) {
      ++counts.most;
    }
    all.push_back(counts);
  }
  return all;
}

/// The share of runs in which the interval misses `probability` at some number of trials.
double missed_at_some_time(double probability) {
  const std::vector<Compatible> compatible = compatible_counts(probability);
  std::mt19937_64 random(17);
  std::bernoulli_distribution event(probability);
  int missed = 0;
  for (int run = 0; run < kRuns; ++run) {
    std::int64_t events = 0;
    for (std::int64_t n = 1; n <= kTrials; ++n) {
      events += event(random) ? 1 : 0;
      const Compatible& counts = compatible[static_cast<std::size_t>(n)];
      if (events >= counts.least && events <= counts.most) continue;
      ++missed;
      break;
    }
  }
  return static_cast<double>(missed) / kRuns;
}

TEST(ConfidenceSequenceCoverage, misses_at_some_time_at_most_as_often_as_it_says) {
  // Four standard errors of the share of kRuns.
  const double room = 4.0 * std::sqrt(kConfidence * (1.0 - kConfidence) / kRuns);
  for (const double probability : {0.002, 0.02, 0.2, 0.5, 0.97}) {
    EXPECT_LE(missed_at_some_time(probability), 1.0 - kConfidence + room) << probability;
  }
}

TEST(ConfidenceSequenceCoverage, is_not_wider_than_it_needs_to_be) {
  // It may miss in 0.1 of the runs over all times; within kTrials it misses in some hundredths.
  for (const double probability : {0.02, 0.2, 0.5}) {
    EXPECT_GE(missed_at_some_time(probability), 0.02) << probability;
  }
}

TEST(ConfidenceSequenceCoverage, an_interval_for_a_fixed_number_does_not_hold_at_all_numbers) {
  // Why the sequence is needed: under repeated looks, the Clopper–Pearson interval misses far more
  // often.
  std::mt19937_64 random(17);
  constexpr int kFewRuns = 300;
  int missed = 0;
  for (int run = 0; run < kFewRuns; ++run) {
    std::int64_t events = 0;
    bool misses = false;
    for (std::int64_t n = 1; n <= kTrials; ++n) {
      events += std::bernoulli_distribution(0.2)(random) ? 1 : 0;
      if (n < 10 || n % 20 != 0) continue;
      const RateInterval interval = clopper_pearson(events, n, 0.5 * (1.0 - kConfidence));
      misses = misses || interval.lower > 0.2 || interval.upper < 0.2;
    }
    missed += misses ? 1 : 0;
  }
  EXPECT_GT(missed, kFewRuns / 4);
}

}  // namespace property_confidence_sequence_test
}  // namespace qsmpc::harness
