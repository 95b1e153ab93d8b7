#include "harness/statistics/confidence_sequence.hpp"

#include <cmath>
#include <cstdint>
#include <stdexcept>

#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace confidence_sequence_test {

TEST(ConfidenceSequence, says_nothing_of_no_trial) {
  EXPECT_EQ(confidence_sequence(0, 0, 0.99).lower, 0.0);
  EXPECT_EQ(confidence_sequence(0, 0, 0.99).upper, 1.0);
}

TEST(ConfidenceSequence, limits_are_where_the_mixture_is_as_much_more_likely_as_the_level_says) {
  // Without an event, M(p) = Γ(n + ½) / (Γ(½) n! (1 − p)ⁿ) in closed form: 1/α at the upper limit.
  constexpr std::int64_t kTrials = 400;
  const RateInterval interval = confidence_sequence(0, kTrials, 0.99);
  const double mixture = std::lgamma(kTrials + 0.5) - std::lgamma(0.5) - std::lgamma(kTrials + 1.0);
  EXPECT_EQ(interval.lower, 0.0);
  EXPECT_NEAR(interval.upper, -std::expm1((mixture + std::log(0.01)) / kTrials), 1e-12);
}

TEST(ConfidenceSequence, is_symmetric_in_what_is_counted) {
  const RateInterval events = confidence_sequence(13, 400, 0.95);
  const RateInterval others = confidence_sequence(387, 400, 0.95);
  // 1 − p loses digits near 1.
  EXPECT_NEAR(events.lower, 1.0 - others.upper, 1e-12);
  EXPECT_NEAR(events.upper, 1.0 - others.lower, 1e-12);
  EXPECT_EQ(confidence_sequence(400, 400, 0.95).upper, 1.0);
}

TEST(ConfidenceSequence, is_wider_than_an_interval_for_that_number_alone_but_not_by_much) {
  for (const std::int64_t trials : {100, 10'000, 1'000'000}) {
    for (const std::int64_t events : {trials / 100, trials / 2}) {
      const RateInterval fixed = clopper_pearson(events, trials, 0.005);
      const RateInterval any = confidence_sequence(events, trials, 0.99);
      EXPECT_LT(any.lower, fixed.lower);
      EXPECT_GT(any.upper, fixed.upper);
      EXPECT_LT(any.upper - any.lower, 2.0 * (fixed.upper - fixed.lower)) << events;
    }
  }
}

TEST(ConfidenceSequence, refuses_impossible_arguments) {
  EXPECT_THROW((void)confidence_sequence(-1, 3, 0.9), std::invalid_argument);
  EXPECT_THROW((void)confidence_sequence(4, 3, 0.9), std::invalid_argument);
  EXPECT_THROW((void)confidence_sequence(1, 3, 1.0), std::invalid_argument);
  EXPECT_THROW((void)confidence_sequence(1, 3, std::nan("")), std::invalid_argument);
}

}  // namespace confidence_sequence_test
}  // namespace qsmpc::harness
