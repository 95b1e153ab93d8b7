// Enclosures of first and second derivatives over boxes, of every system.
#include <cmath>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "models/constants.hpp"
#include "tests/unit/models/dynamics_fixture.hpp"

namespace qsmpc::models {
namespace derivative_bounds_test {

using namespace testing;
// The reference Jacobians are computed by other sums and products, with values of order one hundred
// at most.
constexpr double kRounding = 1e-12;
// Central differences of Jacobians: h² |f''''|/6 + ε |f'|/h for values of order one hundred.
constexpr double kDifferenceStep = 1e-4;
constexpr double kDifferenceTolerance = 1e-5;

struct Box {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
};

class DerivativeBoundsOfEverySystem : public EverySystem {
 protected:
  [[nodiscard]] int arguments() const { return dynamics().state_dim() + dynamics().input_dim(); }

  /// (x, u) at one of the fixture's random states and inputs.
  [[nodiscard]] Eigen::VectorXd random_point() {
    Eigen::VectorXd point(arguments());
    point << states(1).col(0), inputs(1).col(0);
    return point;
  }

  /// A box around a random point, from tiny to as wide as the fixture's states.
  [[nodiscard]] Box random_box() {
    std::uniform_real_distribution<double> exponent(-4.0, 0.5);
    const Eigen::VectorXd first = random_point();
    const double share = std::min(1.0, std::pow(10.0, exponent(generator_)));
    const Eigen::VectorXd second = first + share * (random_point() - first);
    return {first.cwiseMin(second), first.cwiseMax(second)};
  }

  [[nodiscard]] Eigen::VectorXd random_point_in(const Box& box) {
    const Eigen::ArrayXd share = random_batch(generator_, arguments(), 1, 0.5).col(0).array() + 0.5;
    return (box.lower.array() + share * (box.upper - box.lower).array()).matrix();
  }

  [[nodiscard]] Eigen::MatrixXd jacobian(const Eigen::VectorXd& point) const {
    const int dim = dynamics().state_dim();
    Eigen::MatrixXd by_state(dim, dim);
    Eigen::MatrixXd by_input(dim, dynamics().input_dim());
    dynamics().jacobians(point.head(dim), point.tail(dynamics().input_dim()), by_state, by_input);
    Eigen::MatrixXd whole(dim, arguments());
    whole << by_state, by_input;
    return whole;
  }

  /// ∂(row i of the Jacobian)/∂z_axis for all i: column i is column `axis` of the Hessian of f_i.
  [[nodiscard]] Eigen::MatrixXd hessian_columns(const Eigen::VectorXd& point, int axis) const {
    const Eigen::VectorXd offset = kDifferenceStep * Eigen::VectorXd::Unit(arguments(), axis);
    const Eigen::MatrixXd change = jacobian(point + offset) - jacobian(point - offset);
    return change.transpose() / (2.0 * kDifferenceStep);
  }

  [[nodiscard]] DerivativeBounds bounds(const Box& box) const {
    return dynamics().derivative_bounds(box.lower, box.upper);
  }
};

/// Whether lower - slack ≤ value ≤ upper + slack in every entry.
bool encloses(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& upper,
              const Eigen::MatrixXd& value, double slack) {
  return (value.array() >= lower.array() - slack).all() &&
         (value.array() <= upper.array() + slack).all();
}

TEST_P(DerivativeBoundsOfEverySystem, jacobians_in_the_box_are_enclosed) {
  for (int repetition = 0; repetition < 200; ++repetition) {
    const Box box = random_box();
    const DerivativeBounds enclosure = bounds(box);
    for (int sample = 0; sample < 20; ++sample) {
      EXPECT_TRUE(encloses(enclosure.jacobian_lower, enclosure.jacobian_upper,
                           jacobian(random_point_in(box)), kRounding));
    }
  }
}

TEST_P(DerivativeBoundsOfEverySystem, second_derivatives_in_the_box_are_enclosed) {
  for (int repetition = 0; repetition < 100; ++repetition) {
    const Box box = random_box();
    const DerivativeBounds enclosure = bounds(box);
    const Eigen::VectorXd point = random_point_in(box);
    for (int axis = 0; axis < arguments(); ++axis) {
      const Eigen::MatrixXd columns = hessian_columns(point, axis);
      for (int i = 0; i < dynamics().state_dim(); ++i) {
        EXPECT_TRUE(encloses(enclosure.hessian_lower[i].col(axis),
                             enclosure.hessian_upper[i].col(axis), columns.col(i),
                             kDifferenceTolerance))
            << "state " << i << ", axis " << axis;
      }
    }
  }
}

TEST_P(DerivativeBoundsOfEverySystem, hessians_are_symmetric) {
  const DerivativeBounds enclosure = bounds(random_box());
  for (int i = 0; i < dynamics().state_dim(); ++i) {
    EXPECT_EQ(enclosure.hessian_lower[i], enclosure.hessian_lower[i].transpose());
    EXPECT_EQ(enclosure.hessian_upper[i], enclosure.hessian_upper[i].transpose());
  }
}

TEST_P(DerivativeBoundsOfEverySystem, box_of_one_point_gives_the_derivatives_there) {
  for (int repetition = 0; repetition < 50; ++repetition) {
    Eigen::VectorXd point = random_point();
    if (repetition == 0) point.setZero();  // where many derivatives vanish without being constant
    const DerivativeBounds enclosure = bounds({point, point});
    const Eigen::MatrixXd exact = jacobian(point);
    EXPECT_LE((enclosure.jacobian_lower - exact).cwiseAbs().maxCoeff(), kRounding);
    EXPECT_LE((enclosure.jacobian_upper - exact).cwiseAbs().maxCoeff(), kRounding);
    for (int axis = 0; axis < arguments(); ++axis) {
      const Eigen::MatrixXd columns = hessian_columns(point, axis);
      for (int i = 0; i < dynamics().state_dim(); ++i) {
        EXPECT_LE((enclosure.hessian_lower[i].col(axis) - columns.col(i)).cwiseAbs().maxCoeff(),
                  kDifferenceTolerance);
        EXPECT_LE((enclosure.hessian_upper[i].col(axis) - columns.col(i)).cwiseAbs().maxCoeff(),
                  kDifferenceTolerance);
      }
    }
  }
}

TEST_P(DerivativeBoundsOfEverySystem, larger_boxes_have_wider_enclosures) {
  for (int repetition = 0; repetition < 50; ++repetition) {
    const Box outer = random_box();
    const Eigen::VectorXd first = random_point_in(outer);
    const Eigen::VectorXd second = random_point_in(outer);
    const DerivativeBounds wide = bounds(outer);
    const DerivativeBounds narrow = bounds({first.cwiseMin(second), first.cwiseMax(second)});
    EXPECT_TRUE(encloses(wide.jacobian_lower, wide.jacobian_upper, narrow.jacobian_lower, 0.0));
    EXPECT_TRUE(encloses(wide.jacobian_lower, wide.jacobian_upper, narrow.jacobian_upper, 0.0));
    for (int i = 0; i < dynamics().state_dim(); ++i) {
      EXPECT_TRUE(
          encloses(wide.hessian_lower[i], wide.hessian_upper[i], narrow.hessian_lower[i], 0.0));
      EXPECT_TRUE(
          encloses(wide.hessian_lower[i], wide.hessian_upper[i], narrow.hessian_upper[i], 0.0));
    }
  }
}

TEST_P(DerivativeBoundsOfEverySystem, unbounded_positions_cost_nothing) {
  const SystemDescription& system = dynamics().description();
  const Box finite = random_box();
  Box infinite = finite;
  for (const int axis : {system.position_x, system.position_y}) {
    if (axis < 0) continue;
    infinite.lower[axis] = -kInfinity;
    infinite.upper[axis] = kInfinity;
  }
  const DerivativeBounds expected = bounds(finite);
  const DerivativeBounds enclosure = bounds(infinite);
  EXPECT_EQ(enclosure.jacobian_lower, expected.jacobian_lower);
  EXPECT_EQ(enclosure.jacobian_upper, expected.jacobian_upper);
  for (int i = 0; i < dynamics().state_dim(); ++i) {
    EXPECT_EQ(enclosure.hessian_lower[i], expected.hessian_lower[i]);
    EXPECT_EQ(enclosure.hessian_upper[i], expected.hessian_upper[i]);
  }
}

TEST_P(DerivativeBoundsOfEverySystem, whole_space_has_an_enclosure_without_nan) {
  const Eigen::VectorXd infinite = Eigen::VectorXd::Constant(arguments(), kInfinity);
  const DerivativeBounds enclosure = bounds({-infinite, infinite});
  EXPECT_TRUE((enclosure.jacobian_lower.array() <= enclosure.jacobian_upper.array()).all());
  EXPECT_TRUE(encloses(enclosure.jacobian_lower, enclosure.jacobian_upper, jacobian(random_point()),
                       kRounding));
  for (int i = 0; i < dynamics().state_dim(); ++i) {
    EXPECT_TRUE((enclosure.hessian_lower[i].array() <= enclosure.hessian_upper[i].array()).all());
  }
}

TEST_P(DerivativeBoundsOfEverySystem, an_invalid_box_is_refused) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(arguments());
  for (const double lower : {1.0, kInfinity, std::nan("")}) {
    Box box{zero, zero};
    box.lower[0] = lower;
    EXPECT_THROW((void)bounds(box), std::invalid_argument) << "lower " << lower << ", upper 0";
  }
  const Eigen::VectorXd infinite = Eigen::VectorXd::Constant(arguments(), kInfinity);
  EXPECT_THROW((void)bounds({infinite, infinite}), std::invalid_argument);
  EXPECT_THROW((void)bounds({-infinite, -infinite}), std::invalid_argument);
  EXPECT_THROW((void)bounds({zero.head(1), zero.head(1)}), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(systems, DerivativeBoundsOfEverySystem,
                         ::testing::ValuesIn(system_names()));

}  // namespace derivative_bounds_test
}  // namespace qsmpc::models
