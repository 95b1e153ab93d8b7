#include "controller/measure/normal/normal_norms.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "controller/certification/higher_order_norms.hpp"

namespace qsmpc::controller {
namespace normal_norms_test {

// E Z^2m = (2m - 1)!!; for the polynomials by expansion: E(Z^2 - 1)^4 = 105 - 60 + 18 - 4 + 1 and
// E(Z^3 - 3Z)^4 = 10395 - 12 · 945 + 54 · 105 - 108 · 15 + 81 · 3.
TEST(NormalNorms, are_those_of_the_moments) {
  EXPECT_DOUBLE_EQ(normal_power_norm(1, 2), 1.0);
  EXPECT_DOUBLE_EQ(normal_power_norm(3, 2), std::sqrt(15.0));
  EXPECT_DOUBLE_EQ(normal_power_norm(2, 4), std::pow(105.0, 0.25));
  EXPECT_DOUBLE_EQ(normal_square_norm(2), std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(normal_square_norm(4), std::pow(60.0, 0.25));
  EXPECT_DOUBLE_EQ(normal_cube_norm(2), std::sqrt(6.0));
  EXPECT_DOUBLE_EQ(normal_cube_norm(4), std::pow(3348.0, 0.25));
}

/// (E|Z|^(power · order))^(1/order), by the gamma function.
double by_gamma(double power, double order) {
  const double exponent = power * order;
  const double log_moment = 0.5 * exponent * std::numbers::ln2 +
                            std::lgamma(0.5 * (exponent + 1.0)) - 0.5 * std::log(std::numbers::pi);
  return std::exp(log_moment / order);
}

TEST(HigherOrderNorms, are_those_of_their_order) {
  for (std::size_t k = 0; k < kHigherOrders.size(); ++k) {
    const double order = kHigherOrders[k];
    const HigherOrderNorms& norms = higher_order_norms(k);
    EXPECT_NEAR(norms.first / by_gamma(1.0, order), 1.0, 1e-12);
    EXPECT_NEAR(norms.first_twice / by_gamma(1.0, 2.0 * order), 1.0, 1e-12);
    EXPECT_NEAR(norms.fourth / by_gamma(4.0, order), 1.0, 1e-12);
    EXPECT_NEAR(norms.fifth / by_gamma(5.0, order), 1.0, 1e-12);
    // Between what the largest power alone and the triangle inequality give.
    EXPECT_GT(norms.square, by_gamma(2.0, order) - 1.0);
    EXPECT_LT(norms.square, by_gamma(2.0, order));
    EXPECT_GT(norms.cube, by_gamma(3.0, order) - 3.0 * by_gamma(1.0, order));
    EXPECT_LT(norms.cube, by_gamma(3.0, order));
  }
}

TEST(NormalNorms, grow_with_the_order) {
  for (int order = 2; order <= 20; order += 2) {
    EXPECT_LT(normal_power_norm(3, order), normal_power_norm(3, order + 2));
    EXPECT_LT(normal_square_norm(order), normal_square_norm(order + 2));
    EXPECT_LT(normal_cube_norm(order), normal_cube_norm(order + 2));
  }
}

}  // namespace normal_norms_test
}  // namespace qsmpc::controller
