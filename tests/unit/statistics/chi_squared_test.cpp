#include "harness/statistics/chi_squared.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace chi_squared_test {

TEST(ChiSquaredTail, of_two_degrees_is_exponential) {
  for (const double value : {0.0, 1.0, 30.0}) {
    EXPECT_NEAR(chi_squared_tail(value, 2), std::exp(-value / 2.0), 1e-15) << value;
  }
}

TEST(ChiSquaredTail, of_what_is_not_finite_is_not_a_number) {
  EXPECT_TRUE(std::isnan(chi_squared_tail(std::numeric_limits<double>::quiet_NaN(), 3)));
  EXPECT_TRUE(std::isnan(chi_squared_tail(std::numeric_limits<double>::infinity(), 3)));
}

TEST(ChiSquaredTail, refuses_impossible_arguments) {
  EXPECT_THROW((void)chi_squared_tail(-1.0, 3), std::domain_error);
  EXPECT_THROW((void)chi_squared_tail(1.0, 0), std::domain_error);
}

}  // namespace chi_squared_test
}  // namespace qsmpc::harness
