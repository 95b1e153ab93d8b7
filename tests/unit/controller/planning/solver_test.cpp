#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/planning/solvers/ocp_solver.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"
#include "tests/unit/controller/planning/solver_problems.hpp"

namespace qsmpc::controller {
namespace solver_test {

using namespace testing;

using Eigen::VectorXd;

class EverySolver : public ::testing::TestWithParam<SolverChoice> {
 protected:
  [[nodiscard]] bool maps_onto_the_open_box() const {
    return GetParam().bounding == "sigmoid" || GetParam().bounding == "tanh";
  }
  [[nodiscard]] bool may_leave_the_box() const { return GetParam().bounding == "penalty"; }

  std::unique_ptr<OcpSolver> solver_ =
      make_solver(GetParam().solver, {.bounding = GetParam().bounding});
};

TEST_P(EverySolver, finds_the_minimum_inside_the_box) {
  const VectorXd target{{0.1, 1.5, 0.0, -0.5, 0.2, 0.3}};
  const SolverResult& result = solver_->minimise(
      boxed_bowl(target), VectorXd::Zero(6), {.max_evaluations = 500, .relative_tolerance = 1e-14});
  // The value is quadratic about the minimum, so z is accurate to √1e-14, relative to the starting
  // cost of order one, times the sigmoid's condition number.
  EXPECT_LE((result.z - target).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_NE(result.status, SolverStatus::kNumericalTrouble);
  EXPECT_LE(result.evaluations, 500);
  EXPECT_EQ(result.violation, 0.0);
}

TEST_P(EverySolver, goes_to_the_bound_where_the_minimum_lies_beyond) {
  const VectorXd target{{5.0, 0.5, 0.1, -7.0}};
  const OcpProblem problem = boxed_bowl(target);
  const SolverResult& result = solver_->minimise(
      problem, VectorXd::Zero(4), {.max_evaluations = 1000, .relative_tolerance = 1e-14});
  const VectorXd expected{{0.3, 0.5, 0.1, -1.0}};
  // A sigmoid reaches its bound only in the limit: the remainder costs 1e-4 of the slope there. The
  // others reach the bound itself, and the free entries are accurate to √1e-14 again.
  EXPECT_LE((result.z - expected).cwiseAbs().maxCoeff(), maps_onto_the_open_box() ? 1e-3 : 1e-5);
  EXPECT_TRUE(within_bounds(problem, result.z));
}

TEST_P(EverySolver, results_never_leave_the_bounds_not_even_by_rounding) {
  Generator generator(111);
  for (int repetition = 0; repetition < 20; ++repetition) {
    OcpProblem problem = boxed_bowl(VectorXd::Zero(6));
    problem.cost = [&](const VectorXd& z, VectorXd& gradient) {
      EXPECT_TRUE(may_leave_the_box() || within_bounds(problem, z)) << z.transpose();
      gradient.setConstant(-1e6);
      return -1e6 * z.sum();
    };
    const VectorXd start = random_matrix(generator, 6, 1, 0.1);
    const SolverResult& result = solver_->minimise(problem, start, {.max_evaluations = 200});
    EXPECT_TRUE(within_bounds(problem, result.z)) << result.z.transpose();
  }
}

TEST_P(EverySolver, returns_the_value_of_the_best_point_and_respects_the_limit) {
  OcpProblem problem = boxed_bowl(VectorXd::Constant(8, 0.2));
  const CostFunction bowl = problem.cost;
  for (const int limit : {1, 2, 5}) {
    int calls = 0;
    double least = std::numeric_limits<double>::infinity();
    problem.cost = [&](const VectorXd& z, VectorXd& gradient) {
      ++calls;
      const double value = bowl(z, gradient);
      if (within_bounds(problem, z)) least = std::min(least, value);
      return value;
    };
    const SolverResult& result =
        solver_->minimise(problem, VectorXd::Zero(8), {.max_evaluations = limit});
    EXPECT_EQ(result.evaluations, calls);
    EXPECT_LE(calls, limit);
    EXPECT_EQ(result.value, least);
    VectorXd gradient(8);
    EXPECT_EQ(bowl(result.z, gradient), result.value);
  }
}

// On a curved valley every solver needs more evaluations than these. With the penalty the last one
// is kept for the result moved into the bounds, which here needs no move.
TEST_P(EverySolver, uses_all_the_evaluations_that_it_may_make) {
  OcpProblem problem = boxed_bowl(VectorXd::Zero(2));
  problem.lower = VectorXd::Constant(2, -3.0);
  problem.upper = VectorXd::Constant(2, 3.0);
  problem.cost = [](const VectorXd& z, VectorXd& gradient) {
    const double bend = z[1] - z[0] * z[0];
    gradient = VectorXd{{-400.0 * bend * z[0] - 2.0 * (1.0 - z[0]), 200.0 * bend}};
    return 100.0 * bend * bend + (1.0 - z[0]) * (1.0 - z[0]);
  };
  for (const int limit : {2, 3, 6}) {
    const SolverResult& result = solver_->minimise(
        problem, VectorXd{{-1.2, 1.0}}, {.max_evaluations = limit, .relative_tolerance = 1e-14});
    EXPECT_EQ(result.evaluations, may_leave_the_box() ? limit - 1 : limit);
    EXPECT_EQ(result.status, SolverStatus::kIterationLimit);
  }
}

TEST_P(EverySolver, leaves_a_start_at_the_bounds) {
  OcpProblem problem = boxed_bowl(VectorXd{{0.1, 0.5, 0.2, -0.4}});
  const VectorXd start{{0.3, 2.0, -0.1, -1.0}};
  const SolverResult& result =
      solver_->minimise(problem, start, {.max_evaluations = 500, .relative_tolerance = 1e-14});
  EXPECT_LE((result.z - VectorXd{{0.1, 0.5, 0.2, -0.4}}).cwiseAbs().maxCoeff(), 1e-5);
}

TEST_P(EverySolver, bounds_may_be_infinite_on_either_side_and_an_entry_may_be_fixed) {
  OcpProblem problem = boxed_bowl(VectorXd{{3.0, -5.0, 7.0, 0.7, 2.0, 0.1}});
  problem.lower = VectorXd{{-kInfinity, 1.0, 1.0, -kInfinity, 0.4, -1.0}};
  problem.upper = VectorXd{{kInfinity, kInfinity, kInfinity, 0.5, 0.4, 1.0}};
  const VectorXd start{{-1.0, 2.0, 1.0, 0.5, 0.4, 0.0}};
  const SolverResult& result =
      solver_->minimise(problem, start, {.max_evaluations = 1000, .relative_tolerance = 1e-14});
  const VectorXd expected{{3.0, 1.0, 7.0, 0.5, 0.4, 0.1}};
  // As above, a change of variables reaches its bound only in the limit.
  EXPECT_LE((result.z - expected).cwiseAbs().maxCoeff(), maps_onto_the_open_box() ? 1e-3 : 1e-5);
  EXPECT_TRUE(within_bounds(problem, result.z));
}

TEST_P(EverySolver, a_cost_that_is_not_finite_is_a_status_and_keeps_the_start) {
  OcpProblem problem = boxed_bowl(VectorXd::Zero(6));
  problem.cost = [](const VectorXd&, VectorXd& gradient) {
    gradient.setZero();
    return std::nan("");
  };
  const VectorXd start = VectorXd::Constant(6, 0.1);
  const SolverResult& result = solver_->minimise(problem, start, {});
  EXPECT_EQ(result.status, SolverStatus::kNumericalTrouble);
  EXPECT_FALSE(std::isfinite(result.value));
  EXPECT_EQ(result.z, start);
  EXPECT_EQ(result.evaluations, 1);
}

TEST_P(EverySolver, trouble_on_the_way_keeps_the_best_point) {
  OcpProblem problem = boxed_bowl(VectorXd{{0.25, 0.25, 0.25, 0.25, 0.25, 0.25}});
  const CostFunction bowl = problem.cost;
  const VectorXd start{{-0.1, 2.0, -0.1, 1.7, -0.1, 1.9}};
  for (const bool in_gradient : {false, true}) {
    int calls = 0;
    double least = std::numeric_limits<double>::infinity();
    problem.cost = [&](const VectorXd& z, VectorXd& gradient) {
      const double value = bowl(z, gradient);
      if (++calls < 3) {
        if (within_bounds(problem, z)) least = std::min(least, value);
        return value;
      }
      if (in_gradient) gradient[1] = std::numeric_limits<double>::infinity();
      return in_gradient ? value : -std::numeric_limits<double>::infinity();
    };
    const SolverResult& result = solver_->minimise(problem, start, {});
    EXPECT_EQ(result.status, SolverStatus::kNumericalTrouble);
    EXPECT_EQ(result.value, least);
    EXPECT_EQ(calls, 3);
    solver_->forget();
  }
}

TEST_P(EverySolver, a_deadline_that_is_over_returns_the_start) {
  const OcpProblem problem = boxed_bowl(VectorXd::Zero(4));
  const VectorXd start = VectorXd::Constant(4, 0.1);
  const SolverResult& result =
      solver_->minimise(problem, start, {.deadline = std::chrono::steady_clock::now()});
  EXPECT_EQ(result.status, SolverStatus::kDeadline);
  EXPECT_EQ(result.evaluations, 0);
  EXPECT_EQ(result.z, start);
  EXPECT_FALSE(std::isfinite(result.value));
}

TEST_P(EverySolver, no_evaluation_begins_after_the_deadline) {
  OcpProblem problem = boxed_bowl(VectorXd::Constant(4, 0.2));
  const CostFunction bowl = problem.cost;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(250);
  int calls = 0;
  problem.cost = [&](const VectorXd& z, VectorXd& gradient) {
    EXPECT_LT(calls, 2);
    // The second evaluation lasts until the time is up.
    while (calls == 1 && std::chrono::steady_clock::now() < deadline) {
    }
    ++calls;
    return bowl(z, gradient);
  };
  const SolverResult& result =
      solver_->minimise(problem, VectorXd::Constant(4, -0.1), {.deadline = deadline});
  EXPECT_EQ(result.status, SolverStatus::kDeadline);
  EXPECT_TRUE(std::isfinite(result.value));
}

TEST_P(EverySolver, exceptions_of_the_cost_pass_through) {
  OcpProblem problem = boxed_bowl(VectorXd::Zero(6));
  problem.cost = [](const VectorXd&, VectorXd&) -> double {
    throw std::runtime_error("from the cost");
  };
  EXPECT_THROW(solver_->minimise(problem, VectorXd::Zero(6), {}), std::runtime_error);
}

TEST_P(EverySolver, invalid_problems_are_refused) {
  const OcpProblem good = boxed_bowl(VectorXd::Zero(4));
  EXPECT_THROW(solver_->minimise(good, VectorXd::Zero(5), {}), std::invalid_argument);
  EXPECT_THROW(solver_->minimise(good, VectorXd::Zero(4), {.max_evaluations = 0}),
               std::invalid_argument);
  OcpProblem crossed = good;
  crossed.lower[1] = crossed.upper[1] + 1.0;
  EXPECT_THROW(solver_->minimise(crossed, VectorXd::Zero(4), {}), std::invalid_argument);
  crossed.lower[1] = std::nan("");
  EXPECT_THROW(solver_->minimise(crossed, VectorXd::Zero(4), {}), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(solvers, EverySolver, ::testing::ValuesIn(solver_choices()),
                         [](const auto& test) { return test.param.label(); });

TEST(MakeSolver, unknown_names_are_refused_with_the_known_ones) {
  try {
    (void)make_solver("oracle");
    FAIL() << "an unknown solver was made";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("oracle"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr(solvers()[0].name));
  }
  try {
    (void)make_solver("lbfgs", {.bounding = "wall"});
    FAIL() << "an unknown bounding was made";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("wall"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr(input_boundings()[0].name));
  }
}

TEST(SolverStatus, every_status_has_a_name) {
  EXPECT_STREQ(solver_status_name(SolverStatus::kConverged), "converged");
  EXPECT_STREQ(solver_status_name(SolverStatus::kIterationLimit), "iteration_limit");
  EXPECT_STREQ(solver_status_name(SolverStatus::kStalled), "stalled");
  EXPECT_STREQ(solver_status_name(SolverStatus::kDeadline), "deadline");
  EXPECT_STREQ(solver_status_name(SolverStatus::kInfeasible), "infeasible");
  EXPECT_STREQ(solver_status_name(SolverStatus::kNumericalTrouble), "numerical_trouble");
}

}  // namespace solver_test
}  // namespace qsmpc::controller
