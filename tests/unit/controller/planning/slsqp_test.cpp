#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "controller/planning/solvers/ocp_solver.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"
#include "tests/unit/controller/planning/solver_problems.hpp"

namespace qsmpc::controller {
namespace slsqp_test {

using namespace testing;

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kPi = 3.14159265358979323846;

/// The queries made to a set of constraints.
struct Asked {
  std::size_t gradients = 0;
  std::size_t most_at_once = 0;
};

/// Half-planes aᵀz ≤ b, a the columns of `normals`.
ConstraintSet half_planes(const MatrixXd& normals, const VectorXd& offsets, Asked& asked) {
  return {.count = offsets.size(),
          .values = [=](const VectorXd& z,
                        VectorXd& values) { values = normals.transpose() * z - offsets; },
          .some =
              [=, &asked](const VectorXd& z, const std::vector<int>& which, VectorXd& values,
                          MatrixXd& gradients) {
                asked.gradients += which.size();
                asked.most_at_once = std::max(asked.most_at_once, which.size());
                for (std::size_t k = 0; k < which.size(); ++k) {
                  const auto column = static_cast<Eigen::Index>(k);
                  gradients.col(column) = normals.col(which[k]);
                  values[column] = normals.col(which[k]).dot(z) - offsets[which[k]];
                }
              },
          .group = {}};
}

/// ½ |z − centre|² within ±10.
OcpProblem distance_to(const VectorXd& centre) {
  const Eigen::Index n = centre.size();
  return {.cost =
              [centre](const VectorXd& z, VectorXd& gradient) {
                gradient = z - centre;
                return 0.5 * gradient.squaredNorm();
              },
          .lower = VectorXd::Constant(n, -10.0),
          .upper = VectorXd::Constant(n, 10.0),
          .constraints = {}};
}

class Slsqp : public ::testing::Test {
 protected:
  std::unique_ptr<OcpSolver> solver_ = make_solver("slsqp");
  Asked asked_;
  const SolverOptions precise_{.max_evaluations = 400, .relative_tolerance = 1e-12};
};

/// Tangents of the unit circle at `count` angles.
ConstraintSet circle(int count, Asked& asked) {
  MatrixXd normals(2, count);
  for (int j = 0; j < count; ++j) {
    const double angle = 2.0 * kPi * j / count;
    normals(0, j) = std::cos(angle);
    normals(1, j) = std::sin(angle);
  }
  return half_planes(normals, VectorXd::Ones(count), asked);
}

TEST_F(Slsqp, projects_onto_a_polygon_of_thousands_of_sides) {
  constexpr int kSides = 5000;
  OcpProblem problem = distance_to(VectorXd{{3.0, 0.0}});
  problem.constraints = circle(kSides, asked_);
  // Side 0 has the normal (1, 0), so the projection is (1, 0).
  const SolverResult& result = solver_->minimise(problem, VectorXd{{-0.5, 0.3}}, precise_);
  EXPECT_LE((result.z - VectorXd{{1.0, 0.0}}).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_LE(result.violation, 1e-6);
  EXPECT_EQ(result.status, SolverStatus::kConverged);
  EXPECT_LE(asked_.most_at_once, 10U);
}

TEST_F(Slsqp, handles_nearly_dependent_gradients) {
  // Neighbouring tangents differ by a thousandth: NLopt's subproblem then sometimes gives NaN.
  OcpProblem problem = distance_to(VectorXd::Zero(2));
  problem.constraints = circle(5000, asked_);
  for (int repetition = 0; repetition < 100; ++repetition) {
    const VectorXd centre{{3.0 * std::cos(0.7 * repetition), 2.0 * std::sin(0.7 * repetition)}};
    const VectorXd start{{2.0 * std::sin(1.3 * repetition), 2.0 * std::cos(1.9 * repetition)}};
    problem.cost = distance_to(centre).cost;
    const SolverResult& result = solver_->minimise(problem, start, precise_);
    EXPECT_EQ(result.status, SolverStatus::kConverged) << repetition;
    // The polygon's corners are within its angle of the nearest point of the circle.
    EXPECT_LE((result.z - centre.normalized()).norm(), 2e-3) << repetition;
  }
}

TEST_F(Slsqp, grouped_constraints_lead_to_the_same_point) {
  constexpr int kSides = 4000;
  OcpProblem problem = distance_to(VectorXd{{2.0, 2.0}});
  problem.constraints = circle(kSides, asked_);
  problem.constraints->group.resize(kSides);
  for (int j = 0; j < kSides; ++j) problem.constraints->group[j] = j / 500;
  const SolverResult& result = solver_->minimise(problem, VectorXd{{0.0, -3.0}}, precise_);
  EXPECT_LE((result.z - VectorXd::Constant(2, std::sqrt(0.5))).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_EQ(result.status, SolverStatus::kConverged);
}

/// The KKT conditions for ½ |z − centre|² and half-planes: centre − z is a sum of active normals
/// with multipliers ≥ 0. Returns the norm of the remainder.
double kkt_residual(const MatrixXd& normals, const VectorXd& offsets, const VectorXd& centre,
                    const VectorXd& z) {
  std::vector<int> active;
  for (Eigen::Index j = 0; j < offsets.size(); ++j) {
    if (normals.col(j).dot(z) - offsets[j] > -1e-5) active.push_back(static_cast<int>(j));
  }
  if (active.empty()) return (centre - z).norm();
  // Non-negative least squares by projected gradients: slow, simple, and not the method under test.
  const MatrixXd chosen = normals(Eigen::all, active);
  VectorXd multipliers = VectorXd::Zero(chosen.cols());
  const double step = 1.0 / (chosen.transpose() * chosen).trace();
  for (int k = 0; k < 200000; ++k) {
    multipliers =
        (multipliers - step * (chosen.transpose() * (chosen * multipliers - (centre - z))))
            .cwiseMax(0.0);
  }
  return (centre - z - chosen * multipliers).norm();
}

TEST_F(Slsqp, meets_the_conditions_of_optimality_among_thousands_of_half_planes) {
  Generator generator(23);
  const Eigen::Index n = 12;
  const Eigen::Index count = 3000;
  for (int repetition = 0; repetition < 5; ++repetition) {
    MatrixXd normals = random_matrix(generator, n, count);
    normals.colwise().normalize();
    const VectorXd offsets = VectorXd::Ones(count) + random_matrix(generator, count, 1, 0.3);
    const VectorXd centre = random_matrix(generator, n, 1, 2.0);
    OcpProblem problem = distance_to(centre);
    asked_ = {};
    problem.constraints = half_planes(normals, offsets, asked_);
    const SolverResult& result = solver_->minimise(problem, VectorXd::Zero(n), precise_);
    EXPECT_LE(result.violation, 1e-6) << repetition;
    EXPECT_LE((normals.transpose() * result.z - offsets).maxCoeff(), 1e-6);
    // The distance is exact to 1e-12, so z is exact to 1e-6 times the angle between normals.
    EXPECT_LE(kkt_residual(normals, offsets, centre, result.z), 1e-3) << repetition;
    EXPECT_LE(asked_.most_at_once, 5U * n);
  }
}

TEST_F(Slsqp, leaves_an_infeasible_start_that_no_constraint_is_near_to) {
  OcpProblem problem = distance_to(VectorXd{{9.0, 9.0}});
  problem.constraints = circle(1000, asked_);
  const SolverResult& result = solver_->minimise(problem, VectorXd{{-9.0, 8.0}}, precise_);
  EXPECT_LE((result.z - VectorXd::Constant(2, std::sqrt(0.5))).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_LE(result.violation, 1e-6);
}

/// Stays outside discs: r² − |z_{2k..2k+1} − m|² ≤ 0.
ConstraintSet out_of_disc(Eigen::Index pairs, const Eigen::Vector2d& centre, double radius) {
  const auto value = [=](const VectorXd& z, Eigen::Index k) {
    return radius * radius - (z.segment<2>(2 * k) - centre).squaredNorm();
  };
  return {.count = pairs,
          .values =
              [=](const VectorXd& z, VectorXd& values) {
                for (Eigen::Index k = 0; k < pairs; ++k) values[k] = value(z, k);
              },
          .some =
              [=](const VectorXd& z, const std::vector<int>& which, VectorXd& values,
                  MatrixXd& gradients) {
                gradients.setZero();
                for (std::size_t j = 0; j < which.size(); ++j) {
                  const auto column = static_cast<Eigen::Index>(j);
                  const Eigen::Index k = which[j];
                  values[column] = value(z, k);
                  gradients.col(column).segment<2>(2 * k) = -2.0 * (z.segment<2>(2 * k) - centre);
                }
              },
          .group = {}};
}

TEST_F(Slsqp, goes_round_a_disc_though_the_problem_is_not_convex) {
  // The shortest chain of points from (−2, 0) to (2, 0) with none of them in the unit disc about
  // (0, −0.2): a path with its points on the circle or on tangents.
  constexpr Eigen::Index kPoints = 15;
  const Eigen::Index n = 2 * kPoints;
  OcpProblem problem = distance_to(VectorXd::Zero(n));
  problem.cost = [](const VectorXd& z, VectorXd& gradient) {
    double value = 0.0;
    gradient.setZero();
    for (Eigen::Index k = 0; k <= kPoints; ++k) {
      const Eigen::Vector2d from =
          k == 0 ? Eigen::Vector2d(-2.0, 0.0) : Eigen::Vector2d(z.segment<2>(2 * (k - 1)));
      const Eigen::Vector2d to =
          k == kPoints ? Eigen::Vector2d(2.0, 0.0) : Eigen::Vector2d(z.segment<2>(2 * k));
      value += 0.5 * (to - from).squaredNorm();
      if (k > 0) gradient.segment<2>(2 * (k - 1)) -= to - from;
      if (k < kPoints) gradient.segment<2>(2 * k) += to - from;
    }
    return value;
  };
  problem.constraints = out_of_disc(kPoints, Eigen::Vector2d(0.0, -0.2), 1.0);
  VectorXd start(n);
  for (Eigen::Index k = 0; k < kPoints; ++k) {
    start[2 * k] = -2.0 + 4.0 * static_cast<double>(k + 1) / (kPoints + 1);
    start[2 * k + 1] = 0.1;
  }
  const SolverResult& result = solver_->minimise(problem, start, precise_);
  EXPECT_LE(result.violation, 1e-6);
  EXPECT_EQ(result.status, SolverStatus::kConverged);
  // The taut string: two tangents and an arc, in equal pieces up to the corners of the chain.
  const double reach = std::sqrt(4.0 + 0.04);
  const double tangent = std::sqrt(reach * reach - 1.0);
  const double arc = kPi - 2.0 * std::acos(1.0 / reach) - 2.0 * std::asin(0.2 / reach);
  const double length = 2.0 * tangent + arc;
  const double taut = 0.5 * length * length / (kPoints + 1);
  // Chords of 0.27 are 0.3 % shorter than their arcs, and the arc is a fifth of the whole.
  EXPECT_NEAR(result.value, taut, 0.005 * taut);
}

TEST_F(Slsqp, what_cannot_be_kept_is_called_infeasible_and_violated_least) {
  // z_0 ≤ −1 and z_0 ≥ 1: the smallest possible maximum violation is 1, at z_0 = 0.
  MatrixXd normals(2, 2);
  normals << 1.0, -1.0,  //
      0.0, 0.0;
  OcpProblem problem = distance_to(VectorXd{{0.3, 0.4}});
  problem.constraints = half_planes(normals, VectorXd{{-1.0, -1.0}}, asked_);
  const SolverResult& result = solver_->minimise(problem, VectorXd{{0.5, 0.0}}, {});
  EXPECT_EQ(result.status, SolverStatus::kInfeasible);
  EXPECT_LE(result.violation, 1.5);
  EXPECT_EQ(result.violation, (normals.transpose() * result.z).maxCoeff() + 1.0);
  EXPECT_TRUE(std::isfinite(result.value));
}

TEST_F(Slsqp, a_kept_point_is_preferred_to_a_cheaper_one_that_violates) {
  OcpProblem problem = distance_to(VectorXd{{3.0, 0.0}});
  problem.constraints = circle(100, asked_);
  // The start is feasible, so the result is, however few evaluations are allowed.
  for (int limit = 1; limit <= 8; ++limit) {
    const SolverResult& result =
        solver_->minimise(problem, VectorXd{{0.2, 0.3}}, {.max_evaluations = limit});
    EXPECT_LE(result.violation, 1e-6) << limit;
    EXPECT_NE(result.status, SolverStatus::kInfeasible);
    EXPECT_LE(result.evaluations, limit);
  }
  // From an infeasible start, a single evaluation is not enough.
  const SolverResult& result =
      solver_->minimise(problem, VectorXd{{2.0, 0.0}}, {.max_evaluations = 1});
  EXPECT_EQ(result.status, SolverStatus::kInfeasible);
  EXPECT_NEAR(result.violation, 1.0, 1e-12);
}

TEST_F(Slsqp, handles_dozens_of_equal_constraints) {
  const MatrixXd normals = VectorXd{{1.0, 1.0}}.normalized().replicate(1, 60);
  OcpProblem problem = distance_to(VectorXd{{2.0, 2.0}});
  problem.constraints = half_planes(normals, VectorXd::Ones(60), asked_);
  for (const VectorXd& start : {VectorXd{{0.0, 0.0}}, VectorXd{{3.0, 1.0}}}) {
    const SolverResult& result = solver_->minimise(problem, start, precise_);
    EXPECT_LE((result.z - VectorXd::Constant(2, std::sqrt(0.5))).cwiseAbs().maxCoeff(), 1e-5);
    EXPECT_EQ(result.status, SolverStatus::kConverged);
    EXPECT_LE(result.violation, 1e-6);
  }
}

TEST_F(Slsqp, goes_on_with_fewer_constraints_where_bundles_of_them_stall_it) {
  constexpr Eigen::Index kDim = 10;
  constexpr Eigen::Index kBundles = 5;
  constexpr Eigen::Index kEach = 30;
  // How far the normals of a bundle differ: some of these problems stall NLopt's subproblem.
  constexpr double kApart = 1e-6;
  Generator generator(8);
  for (int repetition = 0; repetition < 40; ++repetition) {
    MatrixXd bundles = random_matrix(generator, kDim, kBundles);
    bundles.colwise().normalize();
    const MatrixXd normals =
        bundles.replicate(1, kEach) + random_matrix(generator, kDim, kBundles * kEach, kApart);
    OcpProblem problem = distance_to(random_matrix(generator, kDim, 1, 3.0));
    const VectorXd start = random_matrix(generator, kDim, 1, 5.0);
    problem.constraints = half_planes(bundles, VectorXd::Ones(kBundles), asked_);
    const double expected = solver_->minimise(problem, start, precise_).value;
    problem.constraints = half_planes(normals, VectorXd::Ones(kBundles * kEach), asked_);
    const SolverResult& result = solver_->minimise(problem, start, precise_);
    EXPECT_EQ(result.status, SolverStatus::kConverged) << repetition;
    EXPECT_LE(result.violation, 1e-6) << repetition;
    // By about the multipliers times what the normals differ by.
    EXPECT_NEAR(result.value, expected, 1e-4) << repetition;
  }
}

TEST_F(Slsqp, decisions_of_unlike_units_take_no_more_evaluations) {
  // The same problem in other units, powers of two, so rounding is unaffected.
  const VectorXd units{{1024.0, 1.0, 1.0 / 1024.0, 1.0 / 256.0}};
  const VectorXd centre{{3.0, -4.0, 5.0, -20.0}};
  const auto evaluations = [&](const VectorXd& unit) {
    OcpProblem problem = distance_to(centre);
    problem.lower = problem.lower.cwiseProduct(unit).eval();
    problem.upper = problem.upper.cwiseProduct(unit).eval();
    problem.cost = [&, unit](const VectorXd& z, VectorXd& gradient) {
      const VectorXd difference = z.cwiseQuotient(unit) - centre;
      gradient = difference.cwiseQuotient(unit);
      return 0.5 * difference.squaredNorm();
    };
    return solver_->minimise(problem, VectorXd::Zero(4), precise_).evaluations;
  };
  EXPECT_EQ(evaluations(units), evaluations(VectorXd::Ones(4)));
}

TEST_F(Slsqp, constraints_that_are_not_finite_are_a_status) {
  for (const bool in_gradient : {false, true}) {
    OcpProblem problem = distance_to(VectorXd{{3.0, 0.0}});
    problem.constraints = circle(100, asked_);
    ConstraintSet& set = *problem.constraints;
    int calls = 0;
    const auto some = set.some;
    set.some = [&](const VectorXd& z, const std::vector<int>& which, VectorXd& values,
                   MatrixXd& gradients) {
      some(z, which, values, gradients);
      if (++calls == 3) (in_gradient ? gradients(0, 0) : values[0]) = std::nan("");
    };
    const SolverResult& result = solver_->minimise(problem, VectorXd{{0.2, 0.3}}, {});
    EXPECT_EQ(result.status, SolverStatus::kNumericalTrouble);
    EXPECT_LE(result.violation, 1e-6);
    EXPECT_TRUE(std::isfinite(result.value));
  }
  OcpProblem problem = distance_to(VectorXd{{3.0, 0.0}});
  problem.constraints = circle(100, asked_);
  problem.constraints->values = [](const VectorXd&, VectorXd& values) {
    values.setConstant(std::nan(""));
  };
  const SolverResult& result = solver_->minimise(problem, VectorXd{{0.2, 0.3}}, {});
  EXPECT_EQ(result.status, SolverStatus::kNumericalTrouble);
  EXPECT_EQ(result.z, (VectorXd{{0.2, 0.3}}));
}

TEST_F(Slsqp, groups_must_be_as_many_as_constraints) {
  OcpProblem problem = distance_to(VectorXd{{3.0, 0.0}});
  problem.constraints = circle(100, asked_);
  problem.constraints->group = {0, 1, 2};
  EXPECT_THROW(solver_->minimise(problem, VectorXd::Zero(2), {}), std::invalid_argument);
}

}  // namespace slsqp_test
}  // namespace qsmpc::controller
