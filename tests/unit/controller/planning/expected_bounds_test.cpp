// Penalties of the bounds in expectation over normal noise.
#include "controller/planning/cost/expected_bounds.hpp"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "models/constants.hpp"
#include "tests/support/executors.hpp"
#include "tests/support/point_penalty.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace expected_bounds_test {

using namespace testing;

SafeSet room() {
  SafeSet room = unbounded_safe_set(3);
  room.bounds.lower.head<2>() << -0.5, -kInfinity;
  room.bounds.upper.head<2>() << 0.8, 0.3;
  return room;
}

double expected(ExpectedBounds bounds, const ExpectedBounds::Law& law,
                const DiscreteMeasure& measure, Points& gradient) {
  gradient.setZero(measure.dim(), measure.size());
  return bounds.add(law, measure.locations, measure.weights, run_in_turn, gradient);
}

double unsmoothed(const ExpectedBounds& bounds, const Eigen::VectorXd& deviations,
                  const DiscreteMeasure& measure, Points& gradient) {
  return expected(bounds, ExpectedBounds::Law{.noise_deviation = deviations}, measure, gradient);
}

/// Σ weights_i E h(x_i + n) by the trapezoidal rule over ±9 standard deviations, axis by axis.
double by_quadrature(const SafeSet& safe_set, const Penalty& penalty,
                     const Eigen::VectorXd& deviations, const DiscreteMeasure& measure) {
  constexpr int kNodes = 4000;
  constexpr double kReach = 9.0;
  double total = 0.0;
  for (Eigen::Index axis = 0; axis < measure.dim(); ++axis) {
    SafeSet one = unbounded_safe_set(1);
    one.bounds.lower[0] = safe_set.bounds.lower[axis];
    one.bounds.upper[0] = safe_set.bounds.upper[axis];
    const double width = 2.0 * kReach / kNodes;
    for (int node = 0; node <= kNodes; ++node) {
      const double z = -kReach + width * node;
      Points moved = measure.locations.row(axis);
      moved.array() += deviations[axis] * z;
      Points unused = Points::Zero(1, moved.cols());
      total += width * std::exp(-0.5 * z * z) / std::sqrt(2.0 * M_PI) *
               testing::add_penalty(moved, measure.weights, one, penalty, unused).box;
    }
  }
  return total;
}

TEST(ExpectedBounds, agree_with_quadrature) {
  Generator generator(431);
  const Penalty penalty{.box = 30.0, .length = 0.4};
  const ExpectedBounds bounds(room().bounds, penalty);
  for (const double scale : {0.01, 0.1, 0.5, 2.0}) {
    const DiscreteMeasure measure = random_measure(generator, 3, 21);
    const Eigen::VectorXd deviations = scale * Eigen::Vector3d(1.0, 0.6, 2.0);
    Points gradient;
    const double value = unsmoothed(bounds, deviations, measure, gradient);
    const double reference = by_quadrature(room(), penalty, deviations, measure);
    // The integrand's second derivative jumps, so the rule's error is of second order.
    EXPECT_NEAR(value, reference, 1e-5 * reference + 1e-9) << scale;
  }
}

TEST(ExpectedBounds, are_the_penalties_where_there_is_no_noise) {
  Generator generator(432);
  const Penalty penalty{.box = 30.0, .length = 0.4};
  const DiscreteMeasure measure = random_measure(generator, 3, 37);
  Points gradient;
  const double value = unsmoothed(ExpectedBounds(room().bounds, penalty), Eigen::Vector3d::Zero(),
                                  measure, gradient);
  Points reference = Points::Zero(3, 37);
  EXPECT_NEAR(
      value,
      testing::add_penalty(measure.locations, measure.weights, room(), penalty, reference).box,
      1e-13 * value);
  EXPECT_LE((gradient - reference).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(ExpectedBounds, gradient_is_the_derivative) {
  Generator generator(433);
  const ExpectedBounds bounds(room().bounds, {.box = 30.0, .length = 0.4});
  DiscreteMeasure measure = random_measure(generator, 3, 11);
  for (const auto& [scale, smoothing] :
       {std::pair(0.02, 0.0), std::pair(0.3, 0.0), std::pair(0.1, 0.4), std::pair(0.0, 1.0)}) {
    const Eigen::VectorXd deviations = scale * Eigen::Vector3d(1.0, 0.6, 0.0);
    const ExpectedBounds::Law law{.noise_deviation = deviations, .smoothing = smoothing};
    Points gradient;
    Points unused;
    (void)expected(bounds, law, measure, gradient);
    constexpr double kStep = 1e-6;
    for (Eigen::Index i = 0; i < measure.size(); ++i) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double at = measure.locations(axis, i);
        measure.locations(axis, i) = at + kStep;
        const double above = expected(bounds, law, measure, unused);
        measure.locations(axis, i) = at - kStep;
        const double below = expected(bounds, law, measure, unused);
        measure.locations(axis, i) = at;
        EXPECT_NEAR(gradient(axis, i), (above - below) / (2.0 * kStep), 1e-6);
      }
    }
  }
}

TEST(ExpectedBounds, far_away_nothing_is_lost_or_made_up) {
  const ExpectedBounds bounds(room().bounds, {.box = 1.0, .length = 0.4});
  const Eigen::Vector3d deviations = Eigen::Vector3d::Constant(0.1);
  DiscreteMeasure one{.locations = Points::Zero(3, 1), .weights = Eigen::VectorXd::Ones(1)};
  Points gradient;
  one.locations(0, 0) = 1e9;  // h is ½ + distance/ℓ there
  one.locations(1, 0) = -1e9;
  EXPECT_DOUBLE_EQ(unsmoothed(bounds, deviations, one, gradient), 0.5 + (1e9 - 0.8) / 0.4);
  EXPECT_DOUBLE_EQ(gradient(0, 0), 2.5);
  EXPECT_EQ(gradient(1, 0), 0.0);
  one.locations(0, 0) = std::nan("");
  EXPECT_TRUE(std::isnan(unsmoothed(bounds, deviations, one, gradient)));
}

/// The particles contracted to their mean, and the deviations of the laws they stand for, by
/// definition.
DiscreteMeasure smoothed(const DiscreteMeasure& measure, const ExpectedBounds::Law& law,
                         Eigen::VectorXd& deviations) {
  DiscreteMeasure drawn = measure;
  deviations.resize(measure.dim());
  for (Eigen::Index axis = 0; axis < measure.dim(); ++axis) {
    const Eigen::RowVectorXd at = measure.locations.row(axis);
    const double mean = at * measure.weights;
    const double variance = (at.array() - mean).square().matrix() * measure.weights;
    drawn.locations.row(axis) = mean + std::sqrt(1.0 - law.smoothing) * (at.array() - mean);
    deviations[axis] = std::sqrt(std::pow(law.noise_deviation[axis], 2) + law.smoothing * variance);
  }
  return drawn;
}

TEST(ExpectedBounds, of_smoothed_particles_agree_with_quadrature) {
  Generator generator(434);
  const Penalty penalty{.box = 30.0, .length = 0.4};
  const Eigen::VectorXd noise = Eigen::Vector3d(0.1, 0.05, 0.2);
  for (const double smoothing : {0.2, 0.6, 1.0}) {
    const DiscreteMeasure measure = random_measure(generator, 3, 21);
    const ExpectedBounds::Law law{.noise_deviation = noise, .smoothing = smoothing};
    Points gradient;
    Eigen::VectorXd deviations;
    const DiscreteMeasure drawn = smoothed(measure, law, deviations);
    const double reference = by_quadrature(room(), penalty, deviations, drawn);
    EXPECT_NEAR(expected(ExpectedBounds(room().bounds, penalty), law, measure, gradient), reference,
                1e-5 * reference)
        << smoothing;
  }
}

TEST(ExpectedBounds, all_smoothed_is_one_normal_law) {
  Generator generator(435);
  const ExpectedBounds bounds(room().bounds, {.box = 30.0, .length = 0.4});
  const Eigen::VectorXd noise = Eigen::Vector3d(0.1, 0.05, 0.2);
  const DiscreteMeasure measure = random_measure(generator, 3, 21);
  const ExpectedBounds::Law law{.noise_deviation = noise, .smoothing = 1.0};
  Eigen::VectorXd deviations;
  (void)smoothed(measure, law, deviations);
  const DiscreteMeasure mean{.locations = measure.locations * measure.weights,
                             .weights = Eigen::VectorXd::Ones(1)};
  Points gradient;
  const double value = unsmoothed(bounds, deviations, mean, gradient);
  EXPECT_NEAR(expected(bounds, law, measure, gradient), value, 1e-12 * value);
}

TEST(ExpectedBounds, do_not_depend_on_the_executor) {
  Generator generator(436);
  ExpectedBounds bounds(room().bounds, {.box = 30.0, .length = 0.4});
  const DiscreteMeasure measure = random_measure(generator, 3, 4 * kChunk + 77);
  const Eigen::VectorXd noise = Eigen::Vector3d(0.1, 0.05, 0.2);
  const ExpectedBounds::Law law{.noise_deviation = noise, .smoothing = 0.3};
  Points reference;
  const double value = expected(bounds, law, measure, reference);
  for (const Executor& run : {Executor(run_backwards), Executor(run_on_threads)}) {
    Points gradient = Points::Zero(3, measure.size());
    EXPECT_EQ(bounds.add(law, measure.locations, measure.weights, run, gradient), value);
    EXPECT_EQ(gradient, reference);
  }
}

TEST(ExpectedBounds, smoothing_ends_as_particles_grow_in_number) {
  EXPECT_EQ(smoothing_of(10, 3), 1.0);
  double last = 1.0;
  for (const Eigen::Index count : {100, 1000, 10000, 1000000}) {
    const double smoothing = smoothing_of(count, 3);
    EXPECT_LT(smoothing, last);
    last = smoothing;
  }
  EXPECT_LT(last, 0.05);
  EXPECT_GT(smoothing_of(100, 6), smoothing_of(100, 2));
}

}  // namespace expected_bounds_test
}  // namespace qsmpc::controller
