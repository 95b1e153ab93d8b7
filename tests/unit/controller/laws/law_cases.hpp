// Systems, policies and problems for tests of prediction methods.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "controller/laws/law_propagator.hpp"
#include "models/dynamics/equations/equation_system.hpp"

namespace qsmpc::testing {

/// A problem with everything it refers to.
struct LawCase {
  std::unique_ptr<const models::Dynamics> dynamics;
  controller::Gaussian belief;
  Eigen::MatrixXd noise;
  controller::Policy policy;

  [[nodiscard]] controller::LawProblem problem() const {
    return {.dynamics = *dynamics, .belief = belief, .noise_covariance = noise, .policy = policy};
  }
  /// The laws of `method`, stages 0 … horizon.
  [[nodiscard]] std::vector<controller::StageLaw> laws(
      const std::string& method, const controller::LawSettings& settings = {}) const {
    return controller::make_law_propagator(method, settings)->propagate(problem());
  }
};

/// Zero inputs for `horizon` stages about the belief's mean, with these gains; bounds that no input
/// reaches.
inline controller::Policy unbounded_policy(const models::Dynamics& dynamics,
                                           const Eigen::VectorXd& start, Eigen::Index horizon,
                                           const Eigen::MatrixXd& gain) {
  const Eigen::Index count = dynamics.input_dim();
  const Eigen::MatrixXd inputs = Eigen::MatrixXd::Zero(count, horizon);
  return {.inputs = inputs,
          .states = controller::nominal_states(dynamics, start, inputs),
          .gains = std::vector<Eigen::MatrixXd>(horizon, gain),
          .bounds = {.lower = Eigen::VectorXd::Constant(count, -1e6),
                     .upper = Eigen::VectorXd::Constant(count, 1e6)}};
}

/// The map of these formulas in a, b (and the input u, which is 0), from this belief, with this
/// noise, for `horizon` stages.
inline LawCase map_case(const std::vector<std::string>& formulas, controller::Gaussian belief,
                        Eigen::MatrixXd noise, Eigen::Index horizon = 1) {
  const std::vector<std::string> names{"a", "b"};
  models::EquationSystem system{.states = {},
                                .inputs = {{"u", "1"}},
                                .input_lower = Eigen::VectorXd::Constant(1, -1.0),
                                .input_upper = Eigen::VectorXd::Constant(1, 1.0)};
  for (std::size_t i = 0; i < formulas.size(); ++i) {
    system.states.push_back({names[i], "1"});
    system.equations.push_back({names[i], formulas[i]});
  }
  LawCase made{.dynamics = models::make_equation_dynamics(system, 1.0),
               .belief = std::move(belief),
               .noise = std::move(noise),
               .policy = {}};
  const Eigen::Index dim = made.belief.mean.size();
  made.policy =
      unbounded_policy(*made.dynamics, made.belief.mean, horizon, Eigen::MatrixXd::Zero(1, dim));
  return made;
}

/// The linear double integrator under feedback, and its moments at the last stage.
inline LawCase linear_case(Eigen::Index horizon = 6) {
  LawCase made{.dynamics = models::make_dynamics("double_integrator", {}, 0.2),
               .belief = {.mean = Eigen::Vector2d(1.0, -0.5),
                          .covariance = (Eigen::Matrix2d() << 0.2, 0.05, 0.05, 0.1).finished()},
               .noise = Eigen::Vector2d(0.01, 0.02).asDiagonal(),
               .policy = {}};
  made.policy =
      unbounded_policy(*made.dynamics, made.belief.mean, horizon, Eigen::RowVector2d(-1.0, -1.5));
  return made;
}

/// The moments of the state at stages 0 … horizon of a linear case, by recursion.
inline std::vector<controller::Gaussian> linear_moments(const LawCase& made) {
  const Eigen::Index dim = made.dynamics->state_dim();
  Eigen::MatrixXd by_state(dim, dim);
  Eigen::MatrixXd by_input(dim, made.dynamics->input_dim());
  made.dynamics->jacobians(made.belief.mean, made.policy.inputs.col(0), by_state, by_input);
  std::vector<controller::Gaussian> moments{made.belief};
  for (Eigen::Index k = 0; k < made.policy.horizon(); ++k) {
    const Eigen::MatrixXd closed = by_state + by_input * made.policy.gains[k];
    const controller::Gaussian& now = moments.back();
    moments.push_back(
        {.mean = made.policy.states.col(k + 1) + closed * (now.mean - made.policy.states.col(k)),
         .covariance = closed * now.covariance * closed.transpose() + made.noise});
  }
  return moments;
}

}  // namespace qsmpc::testing
