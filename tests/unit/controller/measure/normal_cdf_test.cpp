// The vectorised normal distribution against the standard library, on every instruction set.
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/unit/controller/measure/normal_cdf_test.cpp"
#include <hwy/foreach_target.h>

#include "controller/measure/normal/normal_cdf-inl.hpp"
#include "models/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace qsmpc::controller {
namespace HWY_NAMESPACE {

using namespace models::HWY_NAMESPACE;

void normal_values_of(const std::vector<double>& z, std::vector<double>& probability,
                      std::vector<double>& density) {
  for_vectors(z.size(), [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
    const NormalValues both = normal_values(load_at(z.data() + i));
    store_at(both.probability, probability.data() + i);
    store_at(both.density, density.data() + i);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::controller
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

#include "tests/support/vector_targets.hpp"

namespace qsmpc::controller {

HWY_EXPORT(normal_values_of);

namespace normal_cdf_test {

using namespace testing;

// As stated in normal_cdf-inl.hpp.
constexpr double kError = 1e-15;

struct Values {
  std::vector<double> probability;
  std::vector<double> density;
};

Values values_of(const std::vector<double>& z) {
  Values values{std::vector<double>(z.size(), 7.0), std::vector<double>(z.size(), 7.0)};
  HWY_DYNAMIC_DISPATCH(normal_values_of)(z, values.probability, values.density);
  return values;
}

std::vector<double> arguments() {
  std::vector<double> all = {0.0,
                             -0.0,
                             1e-300,
                             -1e-300,
                             8.3,
                             -8.3,
                             40.0,
                             -40.0,
                             1e300,
                             -1e300,
                             std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity()};
  for (int n = -9001; n <= 9001; ++n) all.push_back(1e-3 * n);
  return all;
}

TEST(NormalValues, are_within_the_stated_error_of_the_standard_library) {
  const std::vector<double> all = arguments();
  for (const std::int64_t target : testing::vector_targets()) {
    const testing::OnTarget only(target);
    const Values values = values_of(all);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double z = all[i];
      EXPECT_NEAR(values.probability[i], 0.5 * std::erfc(-z / std::numbers::sqrt2), kError) << z;
      EXPECT_NEAR(values.density[i], std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi),
                  kError)
          << z;
    }
  }
}

TEST(NormalValues, probability_does_not_fall_and_stays_within_zero_and_one) {
  // Up to rounding: an edge that is passed twice must not make a part's mass negative.
  const std::vector<double> all = arguments();
  const Values values = values_of(all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_GE(values.probability[i], 0.0);
    EXPECT_LE(values.probability[i], 1.0);
    EXPECT_GE(values.density[i], 0.0);
  }
  for (std::size_t i = 13; i < all.size(); ++i) {
    EXPECT_GE(values.probability[i], values.probability[i - 1] - kError) << all[i];
  }
}

TEST(NormalValues, are_the_same_on_every_target) {
  const std::vector<double> all = arguments();
  const Values best = values_of(all);
  for (const std::int64_t target : testing::vector_targets()) {
    const testing::OnTarget only(target);
    const Values values = values_of(all);
    EXPECT_EQ(values.probability, best.probability) << hwy::TargetName(target);
    EXPECT_EQ(values.density, best.density) << hwy::TargetName(target);
  }
}

TEST(NormalValues, not_a_number_is_not_hidden) {
  for (const std::int64_t target : testing::vector_targets()) {
    const testing::OnTarget only(target);
    const Values values = values_of({std::nan(""), 0.0});
    EXPECT_FALSE(values.probability[0] >= 0.0 && values.probability[0] <= 1.0 &&
                 values.density[0] > 0.0)
        << hwy::TargetName(target);
    EXPECT_EQ(values.probability[1], 0.5) << hwy::TargetName(target);
  }
}

}  // namespace normal_cdf_test
}  // namespace qsmpc::controller
#endif
