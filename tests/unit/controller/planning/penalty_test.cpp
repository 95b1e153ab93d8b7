#include "controller/planning/cost/penalty.hpp"

#include <cmath>
#include <tuple>

#include <gtest/gtest.h>

#include "models/constants.hpp"
#include "tests/support/point_penalty.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace penalty_test {

using namespace testing;
// Central differences of a function with bounded second derivative (weights · 1/ℓ² ≈ 2e3): the
// rounding ε·|f|/h is about 1e-7 of the gradient's scale; kinks are kept 1e-4 away.
constexpr double kDifferenceStep = 1e-6;
constexpr double kKinkMargin = 1e-4;
constexpr double kRelativeTolerance = 1e-6;

SafeSet room() {
  return {.bounds = {.lower = Eigen::Vector3d(-2.0, -2.0, -kInfinity),
                     .upper = Eigen::Vector3d(2.0, kInfinity, 2.5)},
          .obstacles = {Box{.lower = Eigen::Vector3d(-0.5, -1.0, -kInfinity),
                            .upper = Eigen::Vector3d(0.4, 0.7, kInfinity)},
                        Box{.lower = Eigen::Vector3d(0.9, -0.3, -1.0),
                            .upper = Eigen::Vector3d(1.5, 1.0, 0.6)}}};
}

double total(const Points& points, const Eigen::VectorXd& weights, const Penalty& penalty) {
  Points adjoint = Points::Zero(points.rows(), points.cols());
  const testing::PenaltyValue value =
      testing::add_penalty(points, weights, room(), penalty, adjoint);
  return value.box + value.obstacle;
}

Eigen::VectorXd gradient_at(const Eigen::VectorXd& point, const Penalty& penalty) {
  Points adjoint = Points::Zero(point.size(), 1);
  (void)testing::add_penalty(point, Eigen::VectorXd::Ones(1), room(), penalty, adjoint);
  return adjoint.col(0);
}

/// Whether the gradient is nearly the same slightly to every side, so that no kink is near.
bool smooth_near(const Eigen::VectorXd& point, const Penalty& penalty) {
  const Eigen::VectorXd here = gradient_at(point, penalty);
  for (Eigen::Index axis = 0; axis < point.size(); ++axis) {
    for (const double side : {-kKinkMargin, kKinkMargin}) {
      Eigen::VectorXd beside = point;
      beside[axis] += side;
      // Over the margin a smooth gradient changes by less than weight/ℓ² · margin; a kink by
      // weight/ℓ.
      if ((gradient_at(beside, penalty) - here).norm() > 1.0) return false;
    }
  }
  return true;
}

class EveryPenalty : public ::testing::TestWithParam<PenaltyShape> {};

TEST_P(EveryPenalty, gradient_equals_central_differences) {
  const Penalty penalty{.shape = GetParam()};
  Generator generator(81);
  int checked = 0;
  int active = 0;
  for (int repetition = 0; repetition < 3000; ++repetition) {
    const Eigen::VectorXd point = random_matrix(generator, 3, 1, 3.0);
    if (!smooth_near(point, penalty)) continue;
    const Eigen::VectorXd gradient = gradient_at(point, penalty);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      Points high = point;
      Points low = point;
      high(axis, 0) += kDifferenceStep;
      low(axis, 0) -= kDifferenceStep;
      const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
      const double slope =
          (total(high, one, penalty) - total(low, one, penalty)) / (2.0 * kDifferenceStep);
      EXPECT_NEAR(gradient[axis], slope, kRelativeTolerance * (penalty.box + penalty.obstacle))
          << point.transpose();
    }
    ++checked;
    if (!gradient.isZero(0.0)) ++active;
  }
  EXPECT_GT(checked, 2000);
  EXPECT_GT(active, 1000);
}

TEST_P(EveryPenalty, weighs_the_points_and_adds_to_the_adjoint) {
  const Penalty penalty{.shape = GetParam()};
  Generator generator(82);
  const DiscreteMeasure measure = random_measure(generator, 3, 12);
  Points adjoint = Points::Constant(3, 12, 7.0);
  const testing::PenaltyValue value =
      testing::add_penalty(measure.locations, measure.weights, room(), penalty, adjoint);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < 12; ++i) {
    const Eigen::VectorXd point = measure.locations.col(i);
    sum += measure.weights[i] * total(point, Eigen::VectorXd::Ones(1), penalty);
    const Eigen::VectorXd expected =
        measure.weights[i] * gradient_at(point, penalty) + Eigen::VectorXd::Constant(3, 7.0);
    EXPECT_LE((adjoint.col(i) - expected).norm(), 1e-11);  // rounding at gradients of 1e3
  }
  EXPECT_NEAR(value.box + value.obstacle, sum, 1e-11 * sum);
}

INSTANTIATE_TEST_SUITE_P(shapes, EveryPenalty,
                         ::testing::Values(PenaltyShape::kSmooth, PenaltyShape::kThesis),
                         [](const auto& information) {
                           return information.param == PenaltyShape::kSmooth ? "smooth" : "thesis";
                         });

TEST(SmoothPenalty, is_a_half_on_the_boundary_and_grows_inwards) {
  const Penalty penalty{.box = 1.0, .obstacle = 1.0, .length = 0.25};
  const SafeSet pillar{
      .bounds = unbounded_safe_set(1).bounds,
      .obstacles = {Box{.lower = Eigen::VectorXd::Zero(1), .upper = Eigen::VectorXd::Ones(1)}}};
  const auto at = [&](double x) {
    Points adjoint = Points::Zero(1, 1);
    return testing::add_penalty(Points::Constant(1, 1, x), Eigen::VectorXd::Ones(1), pillar,
                                penalty, adjoint)
        .obstacle;
  };
  EXPECT_EQ(at(-0.25), 0.0);
  EXPECT_DOUBLE_EQ(at(-0.125), 0.125);
  EXPECT_DOUBLE_EQ(at(0.0), 0.5);
  EXPECT_DOUBLE_EQ(at(0.25), 1.5);
  EXPECT_DOUBLE_EQ(at(0.5), 2.5);
}

TEST(ThesisPenalty, is_flat_inside_an_obstacle_with_a_halo_of_one) {
  const Penalty penalty{.shape = PenaltyShape::kThesis, .box = 1.0, .obstacle = 10.0};
  const SafeSet pillar{
      .bounds = unbounded_safe_set(1).bounds,
      .obstacles = {Box{.lower = Eigen::VectorXd::Zero(1), .upper = Eigen::VectorXd::Ones(1)}}};
  for (const auto& [x, value, slope] : {std::tuple{0.3, 10.0, 0.0},
                                        {0.9, 10.0, 0.0},
                                        {1.25, 7.5, -10.0},
                                        {-0.5, 5.0, 10.0},
                                        {2.5, 0.0, 0.0}}) {
    Points adjoint = Points::Zero(1, 1);
    EXPECT_DOUBLE_EQ(testing::add_penalty(Points::Constant(1, 1, x), Eigen::VectorXd::Ones(1),
                                          pillar, penalty, adjoint)
                         .obstacle,
                     value);
    EXPECT_DOUBLE_EQ(adjoint(0, 0), slope);
  }
}

}  // namespace penalty_test
}  // namespace qsmpc::controller
