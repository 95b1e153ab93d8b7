#include "controller/certification/saturation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace saturation_test {

using namespace testing;

/// A clamp under N(mean, deviation²).
struct Clamp {
  double mean;
  double deviation;
  double lower;
  double upper;
};

/// Mean, slope and residual of the best affine fit by definition: numerical quadrature of sat(ℓ),
/// sat(ℓ)(ℓ − m)/s² and q² between the kinks, in the arithmetic of `Real`.
/// `norms`, if given, receives those of the residual, as kHigherOrders.
template <class Real>
SaturationFit quadrature(const Clamp& clamp,
                         std::array<double, kHigherOrders.size()>* norms = nullptr) {
  using std::exp;
  using std::pow;
  using std::sqrt;
  const Real mean = clamp.mean;
  const Real deviation = clamp.deviation;
  const Real lower = clamp.lower;
  const Real upper = clamp.upper;
  const Real reach = 14;  // less than 1e-43 is beyond
  std::vector<Real> kinks = {-reach, reach};
  for (const Real& bound : {lower, upper}) {
    const Real kink = (bound - mean) / deviation;
    if (kink > -reach && kink < reach) kinks.push_back(kink);
  }
  std::sort(kinks.begin(), kinks.end());
  const Real scale = 1 / sqrt(8 * atan(Real(1)));
  const auto expectation = [&](const auto& value) {
    Real sum = 0;
    for (std::size_t i = 1; i < kinks.size(); ++i) {
      sum += boost::math::quadrature::gauss_kronrod<Real, 61>::integrate(
          [&](const Real& z) { return Real(value(z) * scale * exp(-z * z / 2)); }, kinks[i - 1],
          kinks[i], 6, Real(1e-13));
    }
    return sum;
  };
  const auto saturated = [&](const Real& z) {
    const Real wanted = mean + deviation * z;
    return wanted < lower ? lower : wanted > upper ? upper : wanted;
  };
  const Real centre = expectation([&](const Real& z) { return saturated(z); });
  const Real slope = expectation([&](const Real& z) { return Real(saturated(z) * z); }) / deviation;
  const Real square = expectation([&](const Real& z) {
    const Real residual = saturated(z) - centre - slope * deviation * z;
    return Real(residual * residual);
  });
  for (std::size_t k = 0; norms != nullptr && k < norms->size(); ++k) {
    const Real moment = expectation([&](const Real& z) {
      const Real residual = saturated(z) - centre - slope * deviation * z;
      return Real(pow(residual, kHigherOrders[k]));
    });
    (*norms)[k] = static_cast<double>(pow(moment, Real(1) / kHigherOrders[k]));
  }
  return {.mean = static_cast<double>(centre),
          .slope = static_cast<double>(slope),
          .residual = static_cast<double>(sqrt(square))};
}

SaturationFit fit(const Clamp& clamp) {
  return fit_saturation(clamp.mean, clamp.deviation, clamp.lower, clamp.upper);
}

TEST(Saturation, fit_equals_numerical_quadrature) {
  Generator generator(91);
  for (int repetition = 0; repetition < 300; ++repetition) {
    Clamp clamp{.mean = uniform(generator, -3.0, 3.0),
                .deviation = std::pow(10.0, uniform(generator, -1.0, 1.0)),
                .lower = uniform(generator, -2.0, 2.0),
                .upper = 0.0};
    clamp.upper = clamp.lower + std::pow(10.0, uniform(generator, -2.0, 1.0));
    const SaturationFit expected = quadrature<double>(clamp);
    const SaturationFit actual = fit(clamp);
    // The quadrature's accuracy, and the allowance for cancellation: √(16ε) of the deviation.
    const double size = 1.0 + clamp.deviation + std::abs(clamp.lower) + std::abs(clamp.upper);
    EXPECT_NEAR(actual.mean, expected.mean, 1e-11 * size);
    EXPECT_NEAR(actual.slope, expected.slope, 1e-11 * size / clamp.deviation);
    EXPECT_NEAR(actual.residual, expected.residual, 3e-7 * size);
    EXPECT_GE(actual.mean, clamp.lower);
    EXPECT_LE(actual.mean, clamp.upper);
  }
}

TEST(Saturation, higher_norms_equal_simulated_ones) {
  Generator generator(93);
  std::normal_distribution<double> normal;
  for (const Clamp& clamp : {Clamp{0.0, 1.0, -0.5, 0.5}, Clamp{2.0, 0.5, -2.0, 2.0},
                             Clamp{0.3, 1.0, -1.5, 2.5}, Clamp{1.5, 1.0, -1.0, 1.0}}) {
    const SaturationFit affine = fit(clamp);
    const auto norms =
        saturation_residual_norms(affine, clamp.mean, clamp.deviation, clamp.lower, clamp.upper);
    std::array<double, kHigherOrders.size()> sums{};
    constexpr int kDraws = 400000;
    for (int i = 0; i < kDraws; ++i) {
      const double offset = clamp.deviation * normal(generator);
      const double q = std::clamp(clamp.mean + offset, clamp.lower, clamp.upper) - affine.mean -
                       affine.slope * offset;
      for (std::size_t k = 0; k < sums.size(); ++k) {
        sums[k] += std::pow(q, kHigherOrders[k]) / kDraws;
      }
    }
    for (std::size_t k = 0; k < sums.size(); ++k) {
      // The mean of an eighth power of a variable with normal tails is within about 10 %, its root
      // within 2 %.
      EXPECT_NEAR(norms[k], std::pow(sums[k], 1.0 / kHigherOrders[k]), 0.02 * norms[k])
          << clamp.mean << " order " << kHigherOrders[k];
    }
  }
}

TEST(Saturation, higher_norms_are_just_above_those_by_quadrature) {
  Generator generator(95);
  for (int repetition = 0; repetition < 100; ++repetition) {
    Clamp clamp{.mean = uniform(generator, -2.0, 2.0),
                .deviation = uniform(generator, 0.3, 3.0),
                .lower = uniform(generator, -2.0, 1.0),
                .upper = 0.0};
    clamp.upper = clamp.lower + uniform(generator, 0.1, 4.0);
    std::array<double, kHigherOrders.size()> expected{};
    (void)quadrature<double>(clamp, &expected);
    const auto norms = saturation_residual_norms(fit(clamp), clamp.mean, clamp.deviation,
                                                 clamp.lower, clamp.upper);
    for (std::size_t k = 0; k < norms.size(); ++k) {
      EXPECT_GE(norms[k], expected[k] * (1.0 - 1e-10)) << "order " << kHigherOrders[k];
      EXPECT_LE(norms[k], expected[k] * (1.0 + 1e-7)) << "order " << kHigherOrders[k];
    }
  }
}

TEST(Saturation, higher_norms_grow_with_the_order_from_the_mean_square) {
  Generator generator(94);
  for (int repetition = 0; repetition < 200; ++repetition) {
    // Not so far outside that the mean square consists only of the allowance for cancellation.
    const double deviation = std::pow(10.0, uniform(generator, -1.0, 1.0));
    const double lower = uniform(generator, -3.0, 3.0);
    const double upper = lower + uniform(generator, 0.01, 4.0);
    const Clamp clamp{.mean = uniform(generator, lower - 2.0 * deviation, upper + 2.0 * deviation),
                      .deviation = deviation,
                      .lower = lower,
                      .upper = upper};
    const SaturationFit affine = fit(clamp);
    const auto norms =
        saturation_residual_norms(affine, clamp.mean, clamp.deviation, clamp.lower, clamp.upper);
    // The mean square includes an allowance for cancellation.
    EXPECT_GE(norms[0], affine.residual * (1.0 - 1e-6) - 1e-6 * clamp.deviation);
    EXPECT_GE(norms[1], norms[0]);
  }
  const auto lost = saturation_residual_norms({}, std::nan(""), 1.0, -1.0, 1.0);
  EXPECT_TRUE(std::isinf(lost[0]));
  EXPECT_EQ(saturation_residual_norms({}, 0.0, 0.0, -1.0, 1.0)[1], 0.0);
}

TEST(Saturation, residual_of_rare_saturation_is_small_and_not_below_the_truth) {
  // The second moments cancel to about 1e-17 of the variance: fifty digits resolve the rest.
  using Real = boost::multiprecision::cpp_bin_float_50;
  for (const double low : {-4.0, -6.0, -6.5, -7.0, -8.0}) {
    for (const double high : {4.5, 6.0, 8.0, 1000.0}) {
      const Clamp clamp{.mean = 0.25, .deviation = 1.0, .lower = low, .upper = high};
      const double truth = quadrature<Real>(clamp).residual;
      const double residual = fit(clamp).residual;
      EXPECT_GE(residual, truth * (1.0 - 1e-15)) << low << " " << high;
      EXPECT_LE(residual, truth * (1.0 + 1e-6)) << low << " " << high;
      EXPECT_GT(truth, 0.0);
    }
  }
}

TEST(Saturation, residual_of_heavy_saturation_is_not_below_the_truth) {
  using Real = boost::multiprecision::cpp_bin_float_50;
  for (const double mean : {-9.0, -5.0, -1.0, 0.0, 3.0, 7.0, 10.0}) {
    for (const double width : {1e-3, 0.1, 2.0}) {
      const Clamp clamp{.mean = mean, .deviation = 1.0, .lower = 0.0, .upper = width};
      const double truth = quadrature<Real>(clamp).residual;
      const double residual = fit(clamp).residual;
      EXPECT_GE(residual, truth * (1.0 - 1e-15)) << mean << " " << width;
      // Moments of order (mean − bound)² cancel where nearly everything is clamped.
      EXPECT_NEAR(residual, truth, 3e-7 * (1.0 + std::abs(mean))) << mean << " " << width;
    }
  }
}

TEST(Saturation, without_spread_is_the_clamp_of_the_mean) {
  for (const double mean : {-3.0, -1.0, 0.25, 2.0, 5.0}) {
    const SaturationFit known = fit({.mean = mean, .deviation = 0.0, .lower = -1.0, .upper = 2.0});
    EXPECT_EQ(known.mean, std::clamp(mean, -1.0, 2.0));
    EXPECT_EQ(known.slope, mean == 0.25 ? 1.0 : 0.0);
    EXPECT_EQ(known.residual, 0.0);
  }
}

TEST(Saturation, largest_residual_is_that_of_a_fine_grid) {
  Generator generator(92);
  constexpr int kGrid = 4000;
  for (int repetition = 0; repetition < 100; ++repetition) {
    const Clamp clamp{.mean = uniform(generator, -3.0, 3.0),
                      .deviation = uniform(generator, 0.0, 2.0),
                      .lower = uniform(generator, -2.0, 0.0),
                      .upper = uniform(generator, 0.1, 2.0)};
    const double reach = std::pow(10.0, uniform(generator, -2.0, 1.0));
    const SaturationFit affine = fit(clamp);
    const double largest =
        largest_saturation_residual(affine, clamp.mean, reach, clamp.lower, clamp.upper);
    double on_grid = 0.0;
    for (int i = 0; i <= kGrid; ++i) {
      const double s = reach * (2.0 * i / kGrid - 1.0);
      const double wanted = std::min(std::max(clamp.mean + s, clamp.lower), clamp.upper);
      on_grid = std::max(on_grid, std::abs(wanted - affine.mean - affine.slope * s));
    }
    EXPECT_GE(largest, on_grid - 1e-13);                // rounding
    EXPECT_LE(largest, on_grid + 2.0 * reach / kGrid);  // slopes are at most one
  }
}

}  // namespace saturation_test
}  // namespace qsmpc::controller
