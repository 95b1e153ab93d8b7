// Problems with known solutions, and the choices of solvers to try on them.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/planning/solvers/ocp_solver.hpp"

namespace qsmpc::testing {

struct SolverChoice {
  std::string solver;
  std::string bounding;
  [[nodiscard]] std::string label() const { return solver + "_" + bounding; }
};

/// Every solver, with every bounding method where there is a choice.
inline std::vector<SolverChoice> solver_choices() {
  std::vector<SolverChoice> choices;
  for (const controller::SolverEntry& solver : controller::solvers()) {
    if (!solver.chooses_bounding) {
      choices.push_back({solver.name, controller::input_boundings()[0].name});
      continue;
    }
    for (const controller::InputBoundingEntry& bounding : controller::input_boundings()) {
      choices.push_back({solver.name, bounding.name});
    }
  }
  return choices;
}

/// ½ Σ_i w_i (z_i − target_i)², w = 1, 4, 1, 4, …, with −0.1 ≤ z_i ≤ 0.3 and −1 ≤ z_i ≤ 2 in turn:
/// separable, so the minimum over the box is the projection of the target.
inline controller::OcpProblem boxed_bowl(const Eigen::VectorXd& target) {
  const Eigen::Index n = target.size();
  controller::OcpProblem problem{
      .cost = {}, .lower = Eigen::VectorXd(n), .upper = Eigen::VectorXd(n), .constraints = {}};
  Eigen::VectorXd weights(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    problem.lower[i] = i % 2 == 0 ? -0.1 : -1.0;
    problem.upper[i] = i % 2 == 0 ? 0.3 : 2.0;
    weights[i] = i % 2 == 0 ? 1.0 : 4.0;
  }
  problem.cost = [target, weights](const Eigen::VectorXd& z, Eigen::VectorXd& gradient) {
    gradient = weights.cwiseProduct(z - target);
    return 0.5 * gradient.dot(z - target);
  };
  return problem;
}

inline bool within_bounds(const controller::OcpProblem& problem, const Eigen::VectorXd& z) {
  return (z.array() >= problem.lower.array()).all() && (z.array() <= problem.upper.array()).all();
}

}  // namespace qsmpc::testing
