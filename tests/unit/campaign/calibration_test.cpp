#include "harness/campaign/statistics/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace calibration_test {

const CalibrationBin& bin_of(const std::vector<CalibrationBin>& bins, double probability) {
  return bins[static_cast<std::size_t>(calibration_bin(probability))];
}

TEST(CalibrationBin, has_half_decades_and_one_bin_for_almost_nothing) {
  EXPECT_EQ(calibration_bin(0.0), 0);
  EXPECT_EQ(calibration_bin(9.9e-13), 0);
  EXPECT_EQ(calibration_bin(1e-12), 1);
  EXPECT_EQ(calibration_bin(0.3), kCalibrationBins - 2);
  EXPECT_EQ(calibration_bin(0.32), kCalibrationBins - 1);
  EXPECT_EQ(calibration_bin(1.0), kCalibrationBins - 1);
  for (int n = 1; n < kCalibrationBins; ++n) {
    const double edge = std::pow(10.0, -12.0 + 0.5 * (n - 1));
    EXPECT_EQ(calibration_bin(edge * (1.0 + 1e-12)), n);
    EXPECT_EQ(calibration_bin(edge * (1.0 - 1e-12)), n - 1);
  }
}

TEST(CalibrationBin, a_value_that_is_not_a_probability_promises_nothing) {
  for (const double value : {1.5, std::numeric_limits<double>::quiet_NaN(), -0.1,
                             std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(calibration_bin(value), kCalibrationBins - 1) << value;
    CalibrationTally tally;
    tally.add(0, value, true);
    EXPECT_EQ(tally.certified(), 1.0);
  }
}

TEST(Calibration, counts_the_periods_of_a_bin) {
  CalibrationTally tally;
  tally.add(0, 0.02, false);
  tally.add(1, 0.03, true);
  tally.add(2, 0.5, true);
  const std::vector<CalibrationBin> bins = tally.result();
  ASSERT_EQ(bins.size(), static_cast<std::size_t>(kCalibrationBins));
  const CalibrationBin& bin = bin_of(bins, 0.02);
  EXPECT_EQ(bin.periods, 2);
  EXPECT_EQ(bin.unsafe, 1);
  EXPECT_DOUBLE_EQ(bin.mean_certified, 0.025);
  EXPECT_DOUBLE_EQ(bin.rate, 0.5);
  EXPECT_EQ(bin.interval.upper, clopper_pearson(1, 2, 0.005).upper);
  EXPECT_EQ(bin_of(bins, 0.5).periods, 1);
  EXPECT_EQ(tally.periods(), 3);
  EXPECT_EQ(tally.unsafe(), 2);
  EXPECT_DOUBLE_EQ(tally.certified(), 0.55);
  EXPECT_TRUE(std::isnan(bins[0].rate));
  EXPECT_EQ(bins[0].p_value, 1.0);
}

TEST(Calibration, a_last_certificate_stands_once_more_in_its_own_bin) {
  CalibrationTally tally;
  tally.add(0, 2e-4, false);  // an episode of two periods
  tally.add(1, 5e-3, true);
  tally.add(0, 3e-4, true);  // and one in progress
  const std::vector<CalibrationBin> bins = tally.result();
  const double large = exceedance_p_value({{.events = 0, .certified = 5e-3}, {1, 5e-3}});
  EXPECT_LT(large, 0.5) << "1 would hide what is in the sums";
  EXPECT_DOUBLE_EQ(bin_of(bins, 5e-3).p_value, large);
  EXPECT_DOUBLE_EQ(bin_of(bins, 2e-4).p_value,
                   exceedance_p_value({{.events = 1, .certified = 5e-4}, {0, 3e-4}}));
  EXPECT_DOUBLE_EQ(tally.p_value(), exceedance_p_value({{.events = 1, .certified = 5.5e-3},
                                                        {.events = 1, .certified = 5.3e-3}}));
  tally.add(1, 3e-4, false);  // does not take part in the result
  EXPECT_DOUBLE_EQ(bin_of(tally.result(), 2e-4).p_value,
                   exceedance_p_value({{.events = 1, .certified = 8e-4}, {0, 3e-4}}));
}

TEST(Calibration, one_event_that_is_all_but_ruled_out_is_enough) {
  CalibrationTally tally;
  for (int n = 0; n < 30; ++n) tally.add(0, 1e-9, false);
  EXPECT_FALSE(bin_of(tally.result(), 1e-9).exceeded);
  tally.add(0, 1e-9, true);
  EXPECT_TRUE(bin_of(tally.result(), 1e-9).exceeded);
  EXPECT_EQ(bin_of(tally.result(), 1e-9).unsafe, 1);
}

TEST(PooledCalibration, adds_counts_but_averages_the_evidence_of_variants) {
  CalibrationTally tally;
  for (int n = 0; n < 1000; ++n) tally.add(0, 0.02, n % 20 == 0);  // 2.5 times too often
  PooledCalibration once;
  once.add(tally);
  PooledCalibration twice = once;
  twice.add(tally);  // the same episodes: no new information
  const CalibrationBin single = bin_of(once.result(), 0.02);
  const CalibrationBin pooled = bin_of(twice.result(), 0.02);
  EXPECT_EQ(pooled.periods, 2 * single.periods);
  EXPECT_EQ(pooled.unsafe, 2 * single.unsafe);
  EXPECT_DOUBLE_EQ(single.p_value, bin_of(tally.result(), 0.02).p_value);
  EXPECT_NEAR(pooled.p_value, single.p_value, 1e-9 * single.p_value);  // rounding
  EXPECT_NEAR(twice.p_value(), tally.p_value(), 1e-9 * tally.p_value());
  EXPECT_EQ(PooledCalibration().p_value(), 1.0);
}

struct Simulation {
  int episodes = 0;
  double promise = 1.0;  ///< certified probability as a share of the true one
};

/// Episodes of up to 40 periods whose risk follows a random walk and grows after each event, so
/// that certificates and events depend on the whole past. An episode ends at its second event. The
/// certificate of a period is made one period ahead: it averages over both possible moves of the
/// risk until the period begins.
CalibrationTally simulated(const Simulation& simulation, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform;
  CalibrationTally tally;
  for (int episode = 0; episode < simulation.episodes; ++episode) {
    double exponent = -1.0 - 2.0 * uniform(random);
    int events = 0;
    for (int period = 0; period < 40 && events < 2; ++period) {
      // e⁰·⁵ times the assumed probability half of the time, else e⁻¹ times: less than 1 on
      // average.
      const double thought = std::pow(10.0, exponent);
      const double truth = thought * std::exp(uniform(random) < 0.5 ? 0.5 : -1.0);
      const bool event = uniform(random) < truth;
      const double average = 0.5 * (std::exp(0.5) + std::exp(-1.0)) * thought;
      tally.add(period, std::min(1.0, average * simulation.promise), event);
      events += event ? 1 : 0;
      exponent = std::min(-0.5, exponent + (event ? 0.5 : 0.4 * (uniform(random) - 0.5)));
    }
  }
  return tally;
}

bool any_exceeded(const std::vector<CalibrationBin>& bins) {
  return std::ranges::any_of(bins, [](const CalibrationBin& bin) { return bin.exceeded; });
}

TEST(Calibration, calls_exact_certificates_exceeded_no_more_often_than_it_says) {
  constexpr int kRuns = 200;
  int called = 0;
  int below_tenth = 0;
  double least = 1.0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const std::vector<CalibrationBin> bins = simulated({.episodes = 60}, run).result();
    called += any_exceeded(bins) ? 1 : 0;
    below_tenth += bin_of(bins, 0.02).p_value < 0.1 ? 1 : 0;
    for (const CalibrationBin& bin : bins) least = std::min(least, bin.p_value);
  }
  EXPECT_LE(called, static_cast<int>(kCalibrationLevel * kRuns));
  EXPECT_LE(below_tenth, kRuns / 10);
  EXPECT_LT(least, 0.2) << "the simulation puts nothing to the test";
}

TEST(Calibration, finds_certificates_that_promise_half_of_what_is_true) {
  for (std::uint64_t run = 0; run < 5; ++run) {
    EXPECT_TRUE(any_exceeded(simulated({.episodes = 600, .promise = 0.5}, run).result())) << run;
  }
}

}  // namespace calibration_test
}  // namespace qsmpc::harness
