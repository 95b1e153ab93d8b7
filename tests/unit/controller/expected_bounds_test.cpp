// Penalties of the bounds in expectation over normal noise.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "controller/planning/stage_kernels.hpp"
#include "tests/unit/controller/random_measures.hpp"

namespace qsmpc::testing {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

SafeSet room() {
  SafeSet room = unbounded_safe_set(3);
  room.bounds.lower.head<2>() << -0.5, -kInfinity;
  room.bounds.upper.head<2>() << 0.8, 0.3;
  return room;
}

double expected(const PenaltyTable& table, const Eigen::VectorXd& deviations,
                const DiscreteMeasure& measure, Points& gradient) {
  gradient.setZero(measure.dim(), measure.size());
  return add_expected_bounds(table, deviations, measure.locations, measure.weights,
                             {0, measure.size()}, gradient);
}

/// Σ weights_i E h(x_i + n) by the trapezoidal rule over ±9 standard deviations, one axis a time.
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
               add_penalty(moved, measure.weights, one, penalty, unused).box;
    }
  }
  return total;
}

TEST(ExpectedBounds, agree_with_quadrature) {
  Generator generator(431);
  const Penalty penalty{.box = 30.0, .length = 0.4};
  const PenaltyTable table(room(), penalty);
  for (const double scale : {0.01, 0.1, 0.5, 2.0}) {
    const DiscreteMeasure measure = random_measure(generator, 3, 21);
    const Eigen::Vector3d deviations = scale * Eigen::Vector3d(1.0, 0.6, 2.0);
    Points gradient;
    const double value = expected(table, deviations, measure, gradient);
    const double reference = by_quadrature(room(), penalty, deviations, measure);
    // The integrand's second derivative jumps, so that the rule's error is of second order.
    EXPECT_NEAR(value, reference, 1e-5 * reference + 1e-9) << scale;
  }
}

TEST(ExpectedBounds, are_the_penalties_where_there_is_no_noise) {
  Generator generator(432);
  const Penalty penalty{.box = 30.0, .length = 0.4};
  const DiscreteMeasure measure = random_measure(generator, 3, 37);
  Points gradient;
  const double value =
      expected(PenaltyTable(room(), penalty), Eigen::Vector3d::Zero(), measure, gradient);
  Points reference = Points::Zero(3, 37);
  EXPECT_NEAR(value,
              add_penalty(measure.locations, measure.weights, room(), penalty, reference).box,
              1e-13 * value);
  EXPECT_LE((gradient - reference).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(ExpectedBounds, gradient_is_the_derivative) {
  Generator generator(433);
  const PenaltyTable table(room(), {.box = 30.0, .length = 0.4});
  DiscreteMeasure measure = random_measure(generator, 3, 11);
  for (const double scale : {0.02, 0.3}) {
    const Eigen::Vector3d deviations = scale * Eigen::Vector3d(1.0, 0.6, 0.0);
    Points gradient;
    Points unused;
    (void)expected(table, deviations, measure, gradient);
    constexpr double kStep = 1e-6;
    for (Eigen::Index i = 0; i < measure.size(); ++i) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double at = measure.locations(axis, i);
        measure.locations(axis, i) = at + kStep;
        const double above = expected(table, deviations, measure, unused);
        measure.locations(axis, i) = at - kStep;
        const double below = expected(table, deviations, measure, unused);
        measure.locations(axis, i) = at;
        EXPECT_NEAR(gradient(axis, i), (above - below) / (2.0 * kStep), 1e-6);
      }
    }
  }
}

TEST(ExpectedBounds, far_away_nothing_is_lost_or_made_up) {
  const PenaltyTable table(room(), {.box = 1.0, .length = 0.4});
  const Eigen::Vector3d deviations = Eigen::Vector3d::Constant(0.1);
  DiscreteMeasure one{.locations = Points::Zero(3, 1), .weights = Eigen::VectorXd::Ones(1)};
  Points gradient;
  one.locations(0, 0) = 1e9;  // h is ½ + distance/ℓ there
  one.locations(1, 0) = -1e9;
  EXPECT_DOUBLE_EQ(expected(table, deviations, one, gradient), 0.5 + (1e9 - 0.8) / 0.4);
  EXPECT_DOUBLE_EQ(gradient(0, 0), 2.5);
  EXPECT_EQ(gradient(1, 0), 0.0);
  one.locations(0, 0) = std::nan("");
  EXPECT_TRUE(std::isnan(expected(table, deviations, one, gradient)));
}

}  // namespace
}  // namespace qsmpc::testing
