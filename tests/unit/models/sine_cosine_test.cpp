// Vectorised sine and cosine against the standard library, on every instruction set.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/unit/models/sine_cosine_test.cpp"
#include <hwy/foreach_target.h>

#include "models/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace qsmpc::models {
namespace HWY_NAMESPACE {

void sine_cosine_of(const std::vector<double>& angles, std::vector<double>& sine,
                    std::vector<double>& cosine) {
  for_vectors(angles.size(), [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
    const SineCosine both = sine_cosine(load_at(angles.data() + i));
    store_at(both.sine, sine.data() + i);
    store_at(both.cosine, cosine.data() + i);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::models
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

#include "tests/support/vector_targets.hpp"

namespace qsmpc::models {

HWY_EXPORT(sine_cosine_of);

namespace sine_cosine_test {

using namespace testing;

// Compared with the standard library's rounded results, which are within one unit of the truth.
constexpr double kUnits = 2.0;

struct Values {
  std::vector<double> sine;
  std::vector<double> cosine;
};

Values values_of(const std::vector<double>& angles) {
  Values values{std::vector<double>(angles.size(), 7.0), std::vector<double>(angles.size(), 7.0)};
  HWY_DYNAMIC_DISPATCH(sine_cosine_of)(angles, values.sine, values.cosine);
  return values;
}

/// Difference in units of the last place of the expected value.
double units_apart(double value, double expected) {
  const double unit = std::nextafter(std::abs(expected), 2.0) - std::abs(expected);
  return std::abs(value - expected) / unit;
}

std::vector<double> angles() {
  std::mt19937_64 generator(17);
  std::vector<double> all;
  const auto add = [&](double angle) {
    all.push_back(angle);
    all.push_back(-angle);
  };
  for (const double scale :
       {1e-300, 1e-8, 1e-3, 1.0, 4.0, 100.0, 1e5, 9.9e5, 1e6, 1.1e6, 1e8, 1e15, 1e300}) {
    std::uniform_real_distribution<double> uniform(0.5 * scale, scale);
    for (int n = 0; n < 500; ++n) add(uniform(generator));
  }
  // Where sine or cosine is nearly zero, and on both sides of the quadrant boundaries.
  for (int quarter = 1; quarter < 700000; quarter = quarter * 3 / 2 + 1) {
    const double edge = 0.25 * quarter * std::numbers::pi;
    add(edge);
    add(std::nextafter(edge, 0.0));
    add(std::nextafter(edge, 1e9));
  }
  add(std::numeric_limits<double>::denorm_min());
  add(std::numeric_limits<double>::max());
  return all;
}

TEST(SineCosine, is_within_two_units_of_the_standard_library) {
  const std::vector<double> all = angles();
  for (const std::int64_t target : testing::vector_targets()) {
    const testing::OnTarget only(target);
    const Values values = values_of(all);
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_LE(units_apart(values.sine[i], std::sin(all[i])), kUnits) << "sine of " << all[i];
      EXPECT_LE(units_apart(values.cosine[i], std::cos(all[i])), kUnits) << "cosine of " << all[i];
    }
  }
}

TEST(SineCosine, is_exact_at_zero_and_nan_where_the_angle_is_not_finite) {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> all = {0.0, -0.0, infinity, -infinity, std::nan(""), 1.0};
  for (const std::int64_t target : testing::vector_targets()) {
    const testing::OnTarget only(target);
    const Values values = values_of(all);
    EXPECT_EQ(values.sine[0], 0.0);
    EXPECT_EQ(values.sine[1], 0.0);
    EXPECT_EQ(values.cosine[0], 1.0);
    EXPECT_EQ(values.cosine[1], 1.0);
    for (int i = 2; i < 5; ++i) {
      EXPECT_TRUE(std::isnan(values.sine[i])) << all[i] << " on " << hwy::TargetName(target);
      EXPECT_TRUE(std::isnan(values.cosine[i])) << all[i] << " on " << hwy::TargetName(target);
    }
    EXPECT_LE(units_apart(values.sine[5], std::sin(1.0)), kUnits);
  }
}

TEST(SineCosine, is_the_same_on_every_target_whatever_stands_beside_it) {
  // An angle that falls back to the standard library must not change the others in its vector.
  std::vector<double> mixed = angles();
  std::shuffle(mixed.begin(), mixed.end(), std::mt19937_64(3));
  const Values best = values_of(mixed);
  for (const std::int64_t target : testing::vector_targets()) {
    const testing::OnTarget only(target);
    const Values values = values_of(mixed);
    for (std::size_t i = 0; i < mixed.size(); ++i) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(values.sine[i]),
                std::bit_cast<std::uint64_t>(best.sine[i]))
          << "sine of " << mixed[i] << " on " << hwy::TargetName(target);
      ASSERT_EQ(std::bit_cast<std::uint64_t>(values.cosine[i]),
                std::bit_cast<std::uint64_t>(best.cosine[i]))
          << "cosine of " << mixed[i] << " on " << hwy::TargetName(target);
    }
  }
}

}  // namespace sine_cosine_test
}  // namespace qsmpc::models
#endif
