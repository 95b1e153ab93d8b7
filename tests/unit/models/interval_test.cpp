// Interval arithmetic encloses, gives the whole line where nothing is known, and is never NaN.
#include "models/dynamics/interval.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "models/constants.hpp"

namespace qsmpc::models {
namespace interval_test {
constexpr double kPi = std::numbers::pi;
// Allowed excess over the exact ends: a few units in the last place of values up to one hundred.
constexpr double kRounding = 1e-13;

bool is_everything(const Interval& interval) {
  return interval.lower() == -kInfinity && interval.upper() == kInfinity;
}

void expect_ends(const Interval& interval, double lower, double upper) {
  EXPECT_LE(interval.lower(), lower);
  EXPECT_GE(interval.upper(), upper);
  if (std::isfinite(lower)) {
    EXPECT_NEAR(interval.lower(), lower, kRounding);
  }
  if (std::isfinite(upper)) {
    EXPECT_NEAR(interval.upper(), upper, kRounding);
  }
}

/// Intervals of all signs and widths, including degenerate and unbounded ones.
std::vector<Interval> all_kinds() {
  const std::vector<double> ends = {-kInfinity, -7.0, -2.5, -1e-9, 0.0, 1e-9, 0.3, 4.0, kInfinity};
  std::vector<Interval> intervals;
  for (const double lower : ends) {
    for (const double upper : ends) {
      if (lower <= upper && lower < kInfinity && upper > -kInfinity) {
        intervals.emplace_back(lower, upper);
      }
    }
  }
  return intervals;
}

/// A number in the interval; of any size if the interval is unbounded.
double random_member(const Interval& interval, std::mt19937_64& generator) {
  const double lower = std::max(interval.lower(), -1e3);
  const double upper = std::min(interval.upper(), 1e3);
  std::uniform_real_distribution<double> share(-0.1, 1.1);  // occasionally one of the ends
  return std::clamp(lower + share(generator) * (upper - lower), lower, upper);
}

struct Unary {
  const char* name;
  std::function<Interval(const Interval&)> of_interval;
  std::function<double(double)> of_number;
};

std::vector<Unary> unary_functions() {
  return {
      {"negation", [](const Interval& a) { return -a; }, [](double a) { return -a; }},
      {"inverse", [](const Interval& a) { return inverse(a); }, [](double a) { return 1.0 / a; }},
      {"square", [](const Interval& a) { return square(a); }, [](double a) { return a * a; }},
      {"sqrt", [](const Interval& a) { return sqrt(a); }, [](double a) { return std::sqrt(a); }},
      {"sin", [](const Interval& a) { return sin(a); }, [](double a) { return std::sin(a); }},
      {"cos", [](const Interval& a) { return cos(a); }, [](double a) { return std::cos(a); }},
      {"tan", [](const Interval& a) { return tan(a); }, [](double a) { return std::tan(a); }},
      {"exp", [](const Interval& a) { return exp(a); }, [](double a) { return std::exp(a); }},
      {"log", [](const Interval& a) { return log(a); }, [](double a) { return std::log(a); }},
      {"asin", [](const Interval& a) { return asin(a); }, [](double a) { return std::asin(a); }},
      {"acos", [](const Interval& a) { return acos(a); }, [](double a) { return std::acos(a); }},
      {"atan", [](const Interval& a) { return atan(a); }, [](double a) { return std::atan(a); }},
      {"sinh", [](const Interval& a) { return sinh(a); }, [](double a) { return std::sinh(a); }},
      {"cosh", [](const Interval& a) { return cosh(a); }, [](double a) { return std::cosh(a); }},
      {"tanh", [](const Interval& a) { return tanh(a); }, [](double a) { return std::tanh(a); }},
      {"abs", [](const Interval& a) { return abs(a); }, [](double a) { return std::abs(a); }},
  };
}

TEST(Interval, functions_enclose_their_values_and_are_never_nan) {
  std::mt19937_64 generator(11);
  for (const Unary& function : unary_functions()) {
    for (const Interval& a : all_kinds()) {
      const Interval range = function.of_interval(a);
      EXPECT_TRUE(range.lower() <= range.upper()) << function.name;
      for (int sample = 0; sample < 50; ++sample) {
        const double value = function.of_number(random_member(a, generator));
        if (std::isfinite(value)) {
          EXPECT_TRUE(range.contains(value)) << function.name;
        }
      }
    }
  }
}

TEST(Interval, operations_enclose_their_values_and_are_never_nan) {
  std::mt19937_64 generator(12);
  for (const Interval& a : all_kinds()) {
    for (const Interval& b : all_kinds()) {
      const Interval sum = a + b;
      const Interval difference = a - b;
      const Interval product = a * b;
      const Interval quotient = a / b;
      const Interval angle = atan2(a, b);
      const Interval least = min(a, b);
      const Interval most = max(a, b);
      for (const Interval& range : {sum, difference, product, quotient, angle, least, most}) {
        EXPECT_TRUE(range.lower() <= range.upper());
      }
      for (int sample = 0; sample < 10; ++sample) {
        const double s = random_member(a, generator);
        const double t = random_member(b, generator);
        EXPECT_TRUE(sum.contains(s + t));
        EXPECT_TRUE(difference.contains(s - t));
        EXPECT_TRUE(product.contains(s * t));
        EXPECT_TRUE(angle.contains(std::atan2(s, t))) << s << ", " << t;
        EXPECT_TRUE(least.contains(std::min(s, t)));
        EXPECT_TRUE(most.contains(std::max(s, t)));
        if (t != 0.0) {
          EXPECT_TRUE(quotient.contains(s / t));
        }
      }
    }
  }
}

// The rounded sum of 1 and 1e-20 is 1, which is not the exact sum.
TEST(Interval, rounding_is_enclosed) {
  const Interval sum = Interval(1.0) + Interval(1e-20);
  EXPECT_LT(sum.lower(), 1.0);
  EXPECT_GT(sum.upper(), 1.0);
  const Interval third = Interval(1.0) / Interval(3.0);
  const Interval back = third + third + third;
  EXPECT_TRUE(back.contains(1.0));
  EXPECT_LT(back.upper() - back.lower(), kRounding);
}

TEST(Interval, waves_have_their_extremes_where_the_interval_holds_them) {
  expect_ends(cos(Interval(0.5, 1.0)), std::cos(1.0), std::cos(0.5));
  expect_ends(cos(Interval(-0.1, 0.2)), std::cos(0.2), 1.0);
  expect_ends(cos(Interval(3.0, 3.5)), -1.0, std::cos(3.5));
  expect_ends(cos(Interval(3.0, 6.5)), -1.0, 1.0);
  expect_ends(sin(Interval(1.0, 2.0)), std::sin(1.0), 1.0);
  expect_ends(sin(Interval(-2.0, -1.0)), -1.0, std::sin(-1.0));
  expect_ends(sin(Interval(101.0, 101.5)), std::sin(101.0), std::sin(101.5));
  for (const double turn : {0.0, 2.0 * kPi, -40.0 * kPi}) {
    expect_ends(sin(Interval(turn - 0.1, turn + 0.1)), std::sin(turn - 0.1), std::sin(turn + 0.1));
  }
}

TEST(Interval, waves_over_a_period_or_more_are_between_minus_one_and_one) {
  for (const Interval& angle : {Interval(0.0, 2.0 * kPi), Interval(-kInfinity, 0.0),
                                Interval(1.0, kInfinity), Interval::everything()}) {
    EXPECT_EQ(sin(angle).lower(), -1.0);
    EXPECT_EQ(sin(angle).upper(), 1.0);
    EXPECT_EQ(cos(angle).lower(), -1.0);
    EXPECT_EQ(cos(angle).upper(), 1.0);
  }
}

TEST(Interval, poles_give_everything) {
  EXPECT_TRUE(is_everything(inverse(Interval(-1.0, 2.0))));
  EXPECT_TRUE(is_everything(Interval(1.0) / Interval(0.0, 2.0)));
  EXPECT_TRUE(is_everything(tan(Interval(1.0, 2.0))));
  EXPECT_TRUE(is_everything(tan(Interval(-5.0, 5.0))));
  expect_ends(tan(Interval(-1.0, 1.5)), std::tan(-1.0), std::tan(1.5));
}

TEST(Interval, zero_times_everything_is_zero) {
  EXPECT_TRUE((Interval(0.0) * Interval::everything()).is_zero());
  EXPECT_TRUE((Interval::everything() * Interval(0.0)).is_zero());
}

TEST(Interval, square_is_not_negative) {
  expect_ends(square(Interval(-2.0, 1.0)), 0.0, 4.0);
  expect_ends(square(Interval(-3.0, -2.0)), 4.0, 9.0);
}

TEST(Interval, overflow_keeps_the_finite_end_on_the_right_side) {
  const Interval huge = Interval(1e300) * Interval(1e300);
  EXPECT_LT(huge.lower(), kInfinity);
  EXPECT_EQ(huge.upper(), kInfinity);
}

}  // namespace interval_test
}  // namespace qsmpc::models
