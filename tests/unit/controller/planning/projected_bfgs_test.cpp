#include <cmath>

#include <gtest/gtest.h>

#include "controller/planning/solvers/box_qp.hpp"
#include "controller/planning/solvers/ocp_solver.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"
#include "tests/unit/controller/planning/solver_problems.hpp"

namespace qsmpc::controller {
namespace projected_bfgs_test {

using namespace testing;

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::unique_ptr<OcpSolver> projected_bfgs() {
  return make_solver("lbfgs", {.bounding = "bounded"});
}

/// ½ (z − centre)ᵀ H (z − centre) without bounds.
OcpProblem quadratic(const MatrixXd& hessian, const VectorXd& centre) {
  const Eigen::Index n = centre.size();
  return {.cost =
              [hessian, centre](const VectorXd& z, VectorXd& gradient) {
                gradient = hessian * (z - centre);
                return 0.5 * gradient.dot(z - centre);
              },
          .lower = VectorXd::Constant(n, -kInfinity),
          .upper = VectorXd::Constant(n, kInfinity),
          .constraints = {}};
}

/// Largest |z − clamp(z − gradient)|: zero where the optimality conditions in the box hold.
double residual(const OcpProblem& problem, const VectorXd& z) {
  VectorXd gradient(z.size());
  problem.cost(z, gradient);
  const VectorXd moved = (z - gradient).cwiseMax(problem.lower).cwiseMin(problem.upper);
  return (z - moved).cwiseAbs().maxCoeff();
}

/// Σ 100 (z_{i+1} − z_i²)² + (1 − z_i)².
OcpProblem rosenbrock(Eigen::Index n) {
  OcpProblem problem = quadratic(MatrixXd::Identity(n, n), VectorXd::Zero(n));
  problem.cost = [](const VectorXd& z, VectorXd& gradient) {
    double value = 0.0;
    gradient.setZero();
    for (Eigen::Index i = 0; i + 1 < z.size(); ++i) {
      const double bend = z[i + 1] - z[i] * z[i];
      value += 100.0 * bend * bend + (1.0 - z[i]) * (1.0 - z[i]);
      gradient[i] += -400.0 * z[i] * bend - 2.0 * (1.0 - z[i]);
      gradient[i + 1] += 200.0 * bend;
    }
    return value;
  };
  return problem;
}

TEST(BoxQp, meets_the_conditions_of_optimality) {
  Generator generator(5);
  for (const Eigen::Index n : {1, 2, 7, 40}) {
    BoxQp qp;
    qp.resize(n);
    for (int repetition = 0; repetition < 20; ++repetition) {
      const MatrixXd hessian = random_spd(generator, n) + MatrixXd::Identity(n, n);
      const VectorXd gradient = random_matrix(generator, n, 1, 5.0);
      const VectorXd lower = random_matrix(generator, n, 1, 0.5).array() - 0.5;
      const VectorXd upper = random_matrix(generator, n, 1, 0.5).array() + 0.5;
      VectorXd step(n);
      ASSERT_TRUE(qp.solve(hessian, gradient, lower, upper, step));
      const VectorXd slope = gradient + hessian * step;
      const VectorXd moved = (step - slope).cwiseMax(lower).cwiseMin(upper);
      EXPECT_LE((step - moved).cwiseAbs().maxCoeff(), 1e-10) << n << ", " << repetition;
      EXPECT_LT(qp.value(), 0.0);
    }
  }
}

TEST(BoxQp, a_matrix_that_is_not_positive_definite_is_refused) {
  BoxQp qp;
  qp.resize(2);
  VectorXd step(2);
  EXPECT_FALSE(qp.solve(-MatrixXd::Identity(2, 2), VectorXd::Ones(2), VectorXd::Constant(2, -1.0),
                        VectorXd::Constant(2, 1.0), step));
}

TEST(ProjectedBfgs, solves_rosenbrocks_valley_with_bounds_in_the_way) {
  OcpProblem problem = rosenbrock(2);
  problem.lower = VectorXd{{-1.5, -0.5}};
  problem.upper = VectorXd{{0.8, 2.0}};
  const VectorXd start{{-1.2, 1.0}};
  const auto solver = projected_bfgs();
  const SolverResult& result =
      solver->minimise(problem, start, {.max_evaluations = 200, .relative_tolerance = 1e-12});
  // With z_0 at its bound 0.8, z_1 = 0.64 is exact.
  EXPECT_EQ(result.z[0], 0.8);
  EXPECT_NEAR(result.z[1], 0.64, 1e-8);
  EXPECT_EQ(result.status, SolverStatus::kConverged);
}

TEST(ProjectedBfgs, solves_the_long_valley_of_many_variables) {
  const auto solver = projected_bfgs();
  const SolverResult& result =
      solver->minimise(rosenbrock(12), VectorXd::Constant(12, -0.5),
                       {.max_evaluations = 1000, .relative_tolerance = 1e-12});
  EXPECT_LE((result.z - VectorXd::Ones(12)).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(ProjectedBfgs, meets_the_conditions_of_optimality_with_many_active_bounds) {
  Generator generator(17);
  for (int repetition = 0; repetition < 20; ++repetition) {
    const Eigen::Index n = 15;
    OcpProblem problem = quadratic(random_spd(generator, n), random_matrix(generator, n, 1, 3.0));
    problem.lower.setConstant(-1.0);
    problem.upper.setConstant(1.0);
    // Every entry starts at a bound.
    const VectorXd start = random_matrix(generator, n, 1).cwiseSign();
    const auto solver = projected_bfgs();
    const SolverResult& result =
        solver->minimise(problem, start, {.max_evaluations = 500, .relative_tolerance = 1e-14});
    // The value, of order 100 here, is exact to 1e-14: this leaves √1e-12 for the slope.
    EXPECT_LE(residual(problem, result.z), 1e-5) << repetition;
  }
}

TEST(ProjectedBfgs, the_cost_never_rises_from_one_limit_to_the_next) {
  const VectorXd start = VectorXd::Constant(6, -0.9);
  double last = kInfinity;
  for (int limit = 1; limit <= 60; ++limit) {
    const auto solver = projected_bfgs();
    const SolverResult& result = solver->minimise(rosenbrock(6), start, {.max_evaluations = limit});
    EXPECT_LE(result.value, last);
    EXPECT_LE(result.evaluations, limit);
    last = result.value;
  }
}

TEST(ProjectedBfgs, does_not_mistake_a_small_step_for_the_minimum) {
  // A wall whose slope is ten thousand times that of the floor behind it: curvature learnt at the
  // wall makes the first steps on the floor tiny.
  OcpProblem problem = quadratic(MatrixXd::Identity(2, 2), VectorXd::Zero(2));
  problem.cost = [](const VectorXd& z, VectorXd& gradient) {
    const double into = std::max(z[0] - 1.0, 0.0);
    gradient = VectorXd{{1e4 * into + z[0] + 3.0, z[1] - 2.0}};
    return 0.5 * (1e4 * into * into + (z[0] + 3.0) * (z[0] + 3.0) + (z[1] - 2.0) * (z[1] - 2.0));
  };
  const auto solver = projected_bfgs();
  const SolverResult& result = solver->minimise(problem, VectorXd{{1.5, 0.0}}, {});
  EXPECT_EQ(result.status, SolverStatus::kConverged);
  EXPECT_NEAR(result.z[0], -3.0, 1e-2);
  EXPECT_NEAR(result.z[1], 2.0, 1e-2);
}

TEST(ProjectedBfgs, comes_to_rest_at_a_kink) {
  // |z_0 − 0.3| + ½ (z_1 − 0.2)²: the gradient does not vanish anywhere near the minimum.
  OcpProblem problem = quadratic(MatrixXd::Identity(2, 2), VectorXd::Zero(2));
  problem.cost = [](const VectorXd& z, VectorXd& gradient) {
    gradient = VectorXd{{z[0] > 0.3 ? 1.0 : -1.0, z[1] - 0.2}};
    return 1.0 + std::abs(z[0] - 0.3) + 0.5 * (z[1] - 0.2) * (z[1] - 0.2);
  };
  const auto solver = projected_bfgs();
  const SolverResult& result = solver->minimise(problem, VectorXd{{-2.0, 3.0}}, {});
  EXPECT_LE(result.value, 1.0 + 1e-2);
  EXPECT_LT(result.evaluations, 100);
}

TEST(ProjectedBfgs, what_was_learnt_saves_evaluations_until_it_is_forgotten) {
  Generator generator(3);
  const MatrixXd hessian = random_spd(generator, 12);
  const SolverOptions options{.max_evaluations = 500, .relative_tolerance = 1e-10};
  const VectorXd start = VectorXd::Zero(12);
  const auto solver = projected_bfgs();
  const VectorXd centre = random_matrix(generator, 12, 1);
  const OcpProblem problem = quadratic(hessian, centre);
  const int cold = solver->minimise(problem, start, options).evaluations;
  const int warm = solver->minimise(problem, start, options).evaluations;
  EXPECT_LE(2 * warm, cold);
  solver->forget();
  EXPECT_EQ(solver->minimise(problem, start, options).evaluations, cold);
}

/// Curvature of stages `first` … `first` + horizon − 1, growing threefold per stage; a gain's
/// follows.
VectorXd staged_curvature(Eigen::Index horizon, Eigen::Index inputs, int first) {
  VectorXd result(horizon * inputs + 1);
  for (Eigen::Index k = 0; k < horizon; ++k) {
    for (Eigen::Index i = 0; i < inputs; ++i) {
      result[k * inputs + i] = std::pow(3.0, static_cast<double>(first + k)) * (1.0 + double(i));
    }
  }
  result[horizon * inputs] = 0.5;
  return result;
}

TEST(ProjectedBfgs, curvature_moves_up_with_the_stages_and_stays_with_the_gains) {
  constexpr Eigen::Index kHorizon = 5;
  constexpr Eigen::Index kInputs = 2;
  const SolverOptions options{.max_evaluations = 500, .relative_tolerance = 1e-13};
  const Eigen::Index n = kHorizon * kInputs + 1;
  const auto evaluations_after = [&](bool shifted) {
    const auto solver = projected_bfgs();
    const VectorXd before = staged_curvature(kHorizon, kInputs, 0);
    // From enough directions to reveal the whole curvature.
    Generator generator(4);
    for (int lesson = 0; lesson < 20; ++lesson) {
      solver->minimise(quadratic(before.asDiagonal(), VectorXd::Ones(n)),
                       random_matrix(generator, n, 1, 3.0), options);
    }
    // One stage later. The last stage's curvature is assumed unchanged.
    VectorXd after = staged_curvature(kHorizon, kInputs, 1);
    after.segment((kHorizon - 1) * kInputs, kInputs) =
        before.segment((kHorizon - 1) * kInputs, kInputs);
    if (shifted) solver->shift({.inputs_per_stage = kInputs, .horizon = kHorizon});
    return solver
        ->minimise(quadratic(after.asDiagonal(), VectorXd::Ones(n)), VectorXd::Zero(n), options)
        .evaluations;
  };
  // With the right curvature the first step almost reaches the minimum.
  EXPECT_LE(3 * evaluations_after(true), evaluations_after(false));
}

TEST(ProjectedBfgs, survives_curvature_of_another_problem) {
  Generator generator(8);
  const auto solver = projected_bfgs();
  const VectorXd centre = VectorXd::Constant(4, 0.7);
  const SolverOptions options{.max_evaluations = 300, .relative_tolerance = 1e-12};
  for (const double scale : {1e6, 1e-6, 1.0}) {
    const MatrixXd hessian = scale * (random_spd(generator, 4) + MatrixXd::Identity(4, 4));
    const SolverResult& result =
        solver->minimise(quadratic(hessian, centre), VectorXd::Zero(4), options);
    EXPECT_LE((result.z - centre).cwiseAbs().maxCoeff(), 1e-4) << scale;
  }
  // A change of size causes a cold start.
  const SolverResult& result = solver->minimise(
      quadratic(MatrixXd::Identity(3, 3), VectorXd::Ones(3)), VectorXd::Zero(3), options);
  EXPECT_LE((result.z - VectorXd::Ones(3)).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(ProjectedBfgs, does_not_mistake_excessive_curvature_for_the_minimum) {
  Generator generator(9);
  const MatrixXd hessian = random_spd(generator, 6) + MatrixXd::Identity(6, 6);
  const VectorXd centre = VectorXd::Constant(6, 0.7);
  const auto solver = projected_bfgs();
  solver->minimise(quadratic(1e8 * hessian, centre), VectorXd::Zero(6), {});
  // The first step now lowers the cost by 1e-8 of itself, less than the tolerance of 1e-6.
  const SolverResult& result = solver->minimise(quadratic(hessian, centre), VectorXd::Zero(6), {});
  EXPECT_EQ(result.status, SolverStatus::kConverged);
  EXPECT_LE((result.z - centre).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(ProjectedBfgs, refuses_constraints) {
  OcpProblem problem = rosenbrock(2);
  problem.constraints = ConstraintSet{};
  EXPECT_THROW(projected_bfgs()->minimise(problem, VectorXd::Zero(2), {}), std::invalid_argument);
}

}  // namespace projected_bfgs_test
}  // namespace qsmpc::controller
