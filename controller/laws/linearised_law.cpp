// The prediction of an extended Kalman filter: means by the map, covariances by its derivative.
#include <memory>

#include "controller/laws/closed_loop_step.hpp"
#include "controller/laws/covariance_root.hpp"
#include "controller/laws/law_makers.hpp"
#include "controller/laws/law_propagator.hpp"

namespace qsmpc::controller {
namespace {

/// ∂g/∂x of the closed loop at `state`: A + B K without the rows of K whose inputs are clamped.
Eigen::MatrixXd closed_loop_jacobian(const LawProblem& problem, Eigen::Index stage,
                                     const Eigen::VectorXd& state) {
  const Policy& policy = problem.policy;
  const Eigen::VectorXd input = policy_input(policy, stage, state);
  Eigen::MatrixXd by_state(state.size(), state.size());
  Eigen::MatrixXd by_input(state.size(), input.size());
  problem.dynamics.jacobians(state, input, by_state, by_input);
  const Eigen::VectorXd free =
      policy.inputs.col(stage) + policy.gains[stage] * (state - policy.states.col(stage));
  for (Eigen::Index i = 0; i < input.size(); ++i) {
    const bool clamped = free[i] < policy.bounds.lower[i] || free[i] > policy.bounds.upper[i];
    if (!clamped) by_state += by_input.col(i) * policy.gains[stage].row(i);
  }
  return by_state;
}

class LinearisedLaw final : public LawPropagator {
 private:
  [[nodiscard]] StageLaw begin(const LawProblem& problem) override {
    return gaussian_law(problem.belief);
  }

  [[nodiscard]] StageLaw advance(const LawProblem& problem, Eigen::Index stage,
                                 const StageLaw& law) override {
    const auto& gaussian = std::get<GaussianMixture>(law);
    const Eigen::MatrixXd jacobian = closed_loop_jacobian(problem, stage, gaussian.means.col(0));
    return gaussian_law({.mean = closed_loop_step(problem, stage, gaussian.means).col(0),
                         .covariance = symmetric_part(jacobian * gaussian.covariances.front() *
                                                      jacobian.transpose()) +
                                       problem.noise_covariance});
  }
};

}  // namespace

LawMethod linearised_law() {
  return {
      .name = "linearised",
      .summary = "A Gaussian propagated by the linearised model, as in the extended Kalman filter",
      .make = [](const LawSettings&) { return std::make_unique<LinearisedLaw>(); }};
}

}  // namespace qsmpc::controller
