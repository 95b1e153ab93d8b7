#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/planning/ocp_solver.hpp"
#include "tests/unit/controller/random_measures.hpp"

namespace qsmpc::testing {
namespace {

InputBounds unit_box() {
  return {.lower = Eigen::Vector2d(-0.1, -1.0), .upper = Eigen::Vector2d(0.3, 2.0)};
}

/// ½ Σ_k (u_k − target_k)ᵀ diag(1, 4) (u_k − target_k): separable, so that the minimum over a box
/// is the target's projection.
CostFunction bowl(const Eigen::MatrixXd& target) {
  return [target](const Eigen::MatrixXd& inputs, Eigen::MatrixXd& gradient) {
    gradient = Eigen::Vector2d(1.0, 4.0).asDiagonal() * (inputs - target);
    return 0.5 * gradient.cwiseProduct(inputs - target).sum();
  };
}

class EverySolver : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<const OcpSolver> solver_ = make_solver(GetParam());
};

TEST_P(EverySolver, finds_the_minimum_inside_the_box) {
  Eigen::MatrixXd target(2, 3);
  target << 0.1, 0.0, 0.2,  //
      1.5, -0.5, 0.3;
  const SolverResult result =
      solver_->minimise(bowl(target), Eigen::MatrixXd::Zero(2, 3), unit_box(),
                        {.max_evaluations = 500, .relative_tolerance = 1e-14});
  // The value falls quadratically about the minimum, so the inputs are as good as √1e-14, relative
  // to the starting cost of the order of one, times the sigmoid's condition.
  EXPECT_LE((result.inputs - target).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_NE(result.status, SolverStatus::kNumericalTrouble);
  EXPECT_LE(result.evaluations, 500);
}

TEST_P(EverySolver, goes_to_the_bound_where_the_minimum_lies_beyond) {
  Eigen::MatrixXd target(2, 2);
  target << 5.0, 0.1,  //
      0.5, -7.0;
  const SolverResult result =
      solver_->minimise(bowl(target), Eigen::MatrixXd::Zero(2, 2), unit_box(),
                        {.max_evaluations = 1000, .relative_tolerance = 1e-14});
  Eigen::MatrixXd expected(2, 2);
  expected << 0.3, 0.1,  //
      0.5, -1.0;
  // A sigmoid nears its bound in the limit only: what is left costs 1e-4 of the slope there.
  EXPECT_LE((result.inputs - expected).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LE(result.inputs.row(0).maxCoeff(), 0.3);
  EXPECT_GE(result.inputs.row(1).minCoeff(), -1.0);
}

TEST_P(EverySolver, inputs_never_leave_the_bounds_not_even_by_rounding) {
  Generator generator(111);
  for (int repetition = 0; repetition < 20; ++repetition) {
    const InputBounds bounds = unit_box();
    const CostFunction steep = [&](const Eigen::MatrixXd& inputs, Eigen::MatrixXd& gradient) {
      for (Eigen::Index k = 0; k < inputs.cols(); ++k) {
        EXPECT_TRUE((inputs.col(k).array() >= bounds.lower.array()).all());
        EXPECT_TRUE((inputs.col(k).array() <= bounds.upper.array()).all());
      }
      gradient.setConstant(-1e6);
      return -1e6 * inputs.sum();
    };
    const Eigen::MatrixXd start = random_matrix(generator, 2, 3, 0.1);
    const SolverResult result = solver_->minimise(steep, start, bounds, {.max_evaluations = 200});
    EXPECT_LE(result.inputs.row(0).maxCoeff(), 0.3);
    EXPECT_LE(result.inputs.row(1).maxCoeff(), 2.0);
  }
}

TEST_P(EverySolver, returns_the_value_of_the_best_inputs_and_respects_the_limit) {
  const Eigen::MatrixXd target = Eigen::MatrixXd::Constant(2, 4, 0.2);
  for (const int limit : {1, 2, 5}) {
    int calls = 0;
    double least = 1e300;
    const CostFunction counted = [&](const Eigen::MatrixXd& inputs, Eigen::MatrixXd& gradient) {
      ++calls;
      const double value = bowl(target)(inputs, gradient);
      least = std::min(least, value);
      return value;
    };
    const SolverResult result = solver_->minimise(counted, Eigen::MatrixXd::Zero(2, 4), unit_box(),
                                                  {.max_evaluations = limit});
    EXPECT_EQ(result.evaluations, calls);
    EXPECT_LE(calls, limit);
    EXPECT_EQ(result.value, least);
    Eigen::MatrixXd gradient(2, 4);
    EXPECT_EQ(bowl(target)(result.inputs, gradient), result.value);
  }
}

TEST_P(EverySolver, a_cost_that_is_not_finite_is_a_status_and_keeps_the_best_point) {
  const CostFunction undefined = [](const Eigen::MatrixXd&, Eigen::MatrixXd& gradient) {
    gradient.setZero();
    return std::nan("");
  };
  const Eigen::MatrixXd start = Eigen::MatrixXd::Constant(2, 3, 0.1);
  SolverResult result = solver_->minimise(undefined, start, unit_box(), {});
  EXPECT_EQ(result.status, SolverStatus::kNumericalTrouble);
  EXPECT_FALSE(std::isfinite(result.value));
  EXPECT_EQ(result.inputs, start);

  int calls = 0;
  const CostFunction breaks_late = [&](const Eigen::MatrixXd& inputs, Eigen::MatrixXd& gradient) {
    const double value = bowl(Eigen::MatrixXd::Constant(2, 3, 0.25))(inputs, gradient);
    if (++calls == 3) gradient(0, 0) = std::nan("");
    return value;
  };
  result = solver_->minimise(breaks_late, start, unit_box(), {});
  EXPECT_EQ(result.status, SolverStatus::kNumericalTrouble);
  EXPECT_TRUE(std::isfinite(result.value));
  EXPECT_EQ(calls, 3);
}

TEST_P(EverySolver, exceptions_of_the_cost_pass_through) {
  const CostFunction throws = [](const Eigen::MatrixXd&, Eigen::MatrixXd&) -> double {
    throw std::runtime_error("from the cost");
  };
  EXPECT_THROW((void)solver_->minimise(throws, Eigen::MatrixXd::Zero(2, 3), unit_box(), {}),
               std::runtime_error);
}

std::vector<std::string> solver_names() {
  std::vector<std::string> names;
  for (const SolverEntry& entry : solvers()) names.push_back(entry.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(solvers, EverySolver, ::testing::ValuesIn(solver_names()));

TEST(MakeSolver, unknown_names_are_refused_with_the_known_ones) {
  try {
    (void)make_solver("oracle");
    FAIL() << "an unknown solver was made";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("oracle"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr(solvers()[0].name));
  }
}

TEST(SolverStatus, every_status_has_a_name) {
  EXPECT_STREQ(solver_status_name(SolverStatus::kConverged), "converged");
  EXPECT_STREQ(solver_status_name(SolverStatus::kIterationLimit), "iteration_limit");
  EXPECT_STREQ(solver_status_name(SolverStatus::kStalled), "stalled");
  EXPECT_STREQ(solver_status_name(SolverStatus::kNumericalTrouble), "numerical_trouble");
}

}  // namespace
}  // namespace qsmpc::testing
