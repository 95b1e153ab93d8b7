#include "harness/statistics/binomial_interval.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace binomial_interval_test {

/// P(X ≥ least) for X ~ Binomial(n, p), term by term.
double upper_tail(int n, int least, double p) {
  double sum = 0.0;
  for (int k = least; k <= n; ++k) {
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) +
                    k * std::log(p) + (n - k) * std::log1p(-p));
  }
  return sum;
}

TEST(ClopperPearson, limits_are_where_the_count_becomes_as_improbable_as_the_tail) {
  for (const double tail : {0.05, 1e-6}) {
    for (const int events : {1, 7, 25, 49}) {
      const RateInterval limits = clopper_pearson(events, 50, tail);
      // 1e-9: the inverse incomplete beta function and the sum above are both close to rounding
      // accuracy.
      EXPECT_NEAR(upper_tail(50, events, limits.lower) / tail, 1.0, 1e-9) << events;
      EXPECT_NEAR((1.0 - upper_tail(50, events + 1, limits.upper)) / tail, 1.0, 1e-6) << events;
    }
  }
}

TEST(ClopperPearson, no_event_and_nothing_but_events_have_the_closed_forms) {
  const RateInterval none = clopper_pearson(0, 1000, 1e-6);
  EXPECT_EQ(none.lower, 0.0);
  EXPECT_NEAR(none.upper, -std::expm1(std::log(1e-6) / 1000.0), 1e-12);
  const RateInterval all = clopper_pearson(1000, 1000, 1e-6);
  EXPECT_NEAR(all.lower, std::exp(std::log(1e-6) / 1000.0), 1e-12);
  EXPECT_EQ(all.upper, 1.0);
}

TEST(ClopperPearson, counts_that_cannot_be_are_refused) {
  EXPECT_THROW(static_cast<void>(clopper_pearson(0, 0, 0.01)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(clopper_pearson(3, 2, 0.01)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(clopper_pearson(-1, 2, 0.01)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(clopper_pearson(1, 2, 0.0)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(clopper_pearson(1, 2, 1.0)), std::invalid_argument);
}

}  // namespace binomial_interval_test
}  // namespace qsmpc::harness
