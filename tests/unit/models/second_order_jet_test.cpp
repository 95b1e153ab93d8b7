// The chain rule to second order, against derivatives by hand.
#include "models/dynamics/second_order_jet.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "models/constants.hpp"

namespace qsmpc::models {
namespace second_order_jet_test {

using Jet = SecondOrderJet<2>;

// A few operations on values of order ten.
constexpr double kRounding = 1e-13;
constexpr double kX = 0.7;
constexpr double kY = -1.3;

void expect_value(const Interval& interval, double value) {
  EXPECT_NEAR(interval.lower(), value, kRounding);
  EXPECT_NEAR(interval.upper(), value, kRounding);
}

struct Derivatives {
  double value, by_x, by_y, by_xx, by_xy, by_yy;
};

void expect_derivatives(const Jet& jet, const Derivatives& expected) {
  expect_value(jet.value(), expected.value);
  expect_value(jet.gradient(0), expected.by_x);
  expect_value(jet.gradient(1), expected.by_y);
  expect_value(jet.hessian(0, 0), expected.by_xx);
  expect_value(jet.hessian(0, 1), expected.by_xy);
  expect_value(jet.hessian(1, 0), expected.by_xy);
  expect_value(jet.hessian(1, 1), expected.by_yy);
}

class SecondOrderJetAtAPoint : public ::testing::Test {
 protected:
  Jet x = Jet::variable(kX, 0);
  Jet y = Jet::variable(kY, 1);
};

TEST_F(SecondOrderJetAtAPoint, sums_and_constants) {
  expect_derivatives(2.0 * x - y / 4.0 + 1.0 - (-x) * 3.0,
                     {5.0 * kX - 0.25 * kY + 1.0, 5.0, -0.25, 0.0, 0.0, 0.0});
}

TEST_F(SecondOrderJetAtAPoint, products) {
  expect_derivatives(x * x * y, {kX * kX * kY, 2.0 * kX * kY, kX * kX, 2.0 * kY, 2.0 * kX, 0.0});
}

TEST_F(SecondOrderJetAtAPoint, products_whose_gradient_vanishes_keep_their_curvature) {
  const Jet zero = Jet::variable(0.0, 0);
  expect_derivatives(zero * zero, {0.0, 0.0, 0.0, 2.0, 0.0, 0.0});
}

TEST_F(SecondOrderJetAtAPoint, quotients) {
  expect_derivatives(x / y, {kX / kY, 1.0 / kY, -kX / (kY * kY), 0.0, -1.0 / (kY * kY),
                             2.0 * kX / (kY * kY * kY)});
  expect_derivatives(1.0 / x, {1.0 / kX, -1.0 / (kX * kX), 0.0, 2.0 / (kX * kX * kX), 0.0, 0.0});
}

TEST_F(SecondOrderJetAtAPoint, waves_of_products) {
  const double s = std::sin(kX * kY);
  const double c = std::cos(kX * kY);
  expect_derivatives(sin(x * y), {s, kY * c, kX * c, -kY * kY * s, c - kX * kY * s, -kX * kX * s});
  expect_derivatives(cos(x * y),
                     {c, -kY * s, -kX * s, -kY * kY * c, -s - kX * kY * c, -kX * kX * c});
}

TEST_F(SecondOrderJetAtAPoint, tangent) {
  const double t = std::tan(kX);
  expect_derivatives(tan(x), {t, 1.0 + t * t, 0.0, 2.0 * t * (1.0 + t * t), 0.0, 0.0});
}

TEST_F(SecondOrderJetAtAPoint, square_root) {
  const double r = std::sqrt(kX);
  expect_derivatives(sqrt(x), {r, 0.5 / r, 0.0, -0.25 / (r * kX), 0.0, 0.0});
}

TEST(SecondOrderJet, pole_makes_only_the_derivatives_that_meet_it_unbounded) {
  const Jet x = Jet::variable(Interval(-1.0, 1.0), 0);
  const Jet y = Jet::variable(Interval(2.0, 3.0), 1);
  const Jet z = 1.0 / x + y;
  EXPECT_EQ(z.gradient(0).lower(), -kInfinity);
  EXPECT_EQ(z.gradient(0).upper(), 0.0);  // -1/x² is never positive
  EXPECT_EQ(z.hessian(0, 0).upper(), kInfinity);
  expect_value(z.gradient(1), 1.0);
  expect_value(z.hessian(0, 1), 0.0);
}

}  // namespace second_order_jet_test
}  // namespace qsmpc::models
