#include "controller/measure/compression/soft_compression.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "controller/measure/compression/compression.hpp"
#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "controller/measure/wasserstein.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace soft_compression_test {

using namespace testing;

// Sums of some hundred terms of order one.
constexpr double kRounding = 1e-12;

/// A hundred points of N(0, 0.01 I) in the plane times eight of noise: one step of the planner.
DiscreteMeasure stepped_belief() {
  const DiscreteMeasure state =
      quantise({.mean = Eigen::Vector2d::Zero(), .covariance = 0.01 * Eigen::Matrix2d::Identity()},
               100)
          .measure;
  const DiscreteMeasure noise =
      quantise({.mean = Eigen::Vector2d::Zero(), .covariance = 0.01 * Eigen::Matrix2d::Identity()},
               8)
          .measure;
  DiscreteMeasure sum{.locations = Points(2, state.size() * noise.size()),
                      .weights = Eigen::VectorXd(state.size() * noise.size())};
  for (Eigen::Index i = 0; i < state.size(); ++i) {
    for (Eigen::Index j = 0; j < noise.size(); ++j) {
      sum.locations.col(i * noise.size() + j) = state.locations.col(i) + noise.locations.col(j);
      sum.weights[i * noise.size() + j] = state.weights[i] * noise.weights[j];
    }
  }
  return sum;
}

double kept_variance(const DiscreteMeasure& measure, const SoftCompression& compression) {
  return covariance_of(compression.measure).trace() / covariance_of(measure).trace();
}

TEST(SoftCompression, keeps_mass_and_mean_and_accounts_for_the_lost_covariance) {
  Generator generator(61);
  for (const double sharpness : {0.1, 1.0, 10.0, 1e3, 1e6}) {
    for (const int count : {1, 2, 7, 30}) {
      for (const int rounds : {1, 3, 50}) {
        const DiscreteMeasure measure = random_measure(generator, 3, 90);
        const SoftCompression compression =
            compress_soft(measure, {.count = count, .sharpness = sharpness, .rounds = rounds});
        EXPECT_LE(compression.measure.size(), count);
        EXPECT_NEAR(compression.measure.weights.sum(), 1.0, kRounding);
        EXPECT_LE((mean_of(compression.measure) - mean_of(measure)).norm(), kRounding);
        EXPECT_LE((covariance_of(compression.measure) + compression.within_covariance -
                   covariance_of(measure))
                      .norm(),
                  kRounding);
        EXPECT_LE((compression.responsibilities.rowwise().sum().array() - 1.0).abs().maxCoeff(),
                  kRounding);
      }
    }
  }
}

TEST(SoftCompression, w2_is_the_cost_of_its_coupling_and_bounds_the_distance) {
  Generator generator(62);
  for (const double sharpness : {0.5, 3.0, 100.0}) {
    const DiscreteMeasure measure = random_measure(generator, 2, 70);
    const SoftCompression compression =
        compress_soft(measure, {.count = 9, .sharpness = sharpness, .rounds = 20});
    double cost = 0.0;
    for (Eigen::Index i = 0; i < measure.size(); ++i) {
      for (Eigen::Index n = 0; n < compression.measure.size(); ++n) {
        cost += measure.weights[i] * compression.responsibilities(i, n) *
                (measure.locations.col(i) - compression.measure.locations.col(n)).squaredNorm();
      }
    }
    EXPECT_NEAR(compression.w2, std::sqrt(cost), kRounding);
    EXPECT_GE(compression.w2, wasserstein2(measure, compression.measure) - kRounding);
  }
}

TEST(SoftCompression, a_small_sharpness_loses_the_variance_and_a_growing_one_keeps_more) {
  const DiscreteMeasure measure = stepped_belief();
  const auto kept = [&](double sharpness) {
    return kept_variance(
        measure, compress_soft(measure, {.count = 100, .sharpness = sharpness, .rounds = 300}));
  };
  // All centres contract to the mean; after three hundred rounds less than a thousandth is left.
  EXPECT_LE(kept(5.0), 1e-3);
  double before = 0.0;
  for (const double sharpness : {5.0, 20.0, 50.0, 200.0}) {
    const double now = kept(sharpness);
    EXPECT_GE(now, before) << sharpness;
    before = now;
  }
  // The hard form keeps 98.7 %; the two converge to different local minima.
  EXPECT_NEAR(before,
              covariance_of(compress(measure, 100, kToConvergence).measure).trace() /
                  covariance_of(measure).trace(),
              0.01);
}

TEST(SoftCompression, a_large_sharpness_is_the_hard_compression) {
  Generator generator(63);
  for (int repetition = 0; repetition < 5; ++repetition) {
    const DiscreteMeasure measure = random_measure(generator, 2, 100);
    const Compression hard = compress(measure, 10, kToConvergence);
    const SoftCompression soft =
        compress_soft(measure, {.count = 10, .sharpness = 1e9, .rounds = 1000});
    // To be shared, a point would have to lie within 1e-8 of the midpoint of two centres.
    EXPECT_TRUE(soft.converged);
    EXPECT_LE((soft.measure.locations - hard.measure.locations).norm(), kRounding);
    EXPECT_LE((soft.measure.weights - hard.measure.weights).norm(), kRounding);
    EXPECT_NEAR(soft.w2, hard.w2, kRounding);
  }
}

TEST(SoftCompression, says_whether_its_centres_came_to_rest) {
  Generator generator(64);
  const DiscreteMeasure measure = random_measure(generator, 2, 100);
  EXPECT_FALSE(compress_soft(measure, {.count = 10, .sharpness = 20.0, .rounds = 1}).converged);
  EXPECT_TRUE(compress_soft(measure, {.count = 10, .sharpness = 20.0, .rounds = 10000}).converged);
}

TEST(SoftCompression, refuses_invalid_settings_and_measures) {
  Generator generator(65);
  const DiscreteMeasure good = random_measure(generator, 2, 10);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const SoftCompressionSettings& bad :
       {SoftCompressionSettings{.count = 0}, SoftCompressionSettings{.rounds = 0},
        SoftCompressionSettings{.sharpness = 0.0}, SoftCompressionSettings{.sharpness = -1.0},
        SoftCompressionSettings{.sharpness = std::nan("")},
        SoftCompressionSettings{.sharpness = infinity}, SoftCompressionSettings{.tolerance = -1e-9},
        SoftCompressionSettings{.tolerance = std::nan("")}}) {
    EXPECT_THROW((void)compress_soft(good, bad), std::invalid_argument);
  }
  DiscreteMeasure weightless = good;
  weightless.weights.setZero();
  DiscreteMeasure undefined = good;
  undefined.weights[3] = std::nan("");
  for (const DiscreteMeasure& bad : {weightless, undefined, DiscreteMeasure{}}) {
    EXPECT_THROW((void)compress_soft(bad, {.count = 2}), std::invalid_argument);
  }
}

}  // namespace soft_compression_test
}  // namespace qsmpc::controller
