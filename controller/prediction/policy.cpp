#include "controller/prediction/policy.hpp"

#include <Eigen/Cholesky>

namespace qsmpc {

Eigen::VectorXd policy_input(const Policy& policy, Eigen::Index stage,
                             const Eigen::Ref<const Eigen::VectorXd>& state) {
  const Eigen::VectorXd wanted =
      policy.inputs.col(stage) + policy.gains[stage] * (state - policy.states.col(stage));
  return wanted.cwiseMax(policy.bounds.lower).cwiseMin(policy.bounds.upper);
}

void policy_inputs(const Policy& policy, Eigen::Index stage, const Points& states, Points& out) {
  const Eigen::MatrixXd& gain = policy.gains[stage];
  for (Eigen::Index input = 0; input < out.rows(); ++input) {
    auto row = out.row(input).array();
    const double constant =
        policy.inputs(input, stage) - gain.row(input).dot(policy.states.col(stage));
    row = constant;
    for (Eigen::Index axis = 0; axis < states.rows(); ++axis) {
      if (gain(input, axis) != 0.0) row += gain(input, axis) * states.row(axis).array();
    }
    row = row.max(policy.bounds.lower[input]).min(policy.bounds.upper[input]);
  }
}

Eigen::MatrixXd nominal_states(const Dynamics& dynamics,
                               const Eigen::Ref<const Eigen::VectorXd>& start,
                               const Eigen::Ref<const Eigen::MatrixXd>& inputs) {
  Eigen::MatrixXd states(start.size(), inputs.cols() + 1);
  states.col(0) = start;
  StateBatch state = start;
  StateBatch next(start.size(), 1);
  for (Eigen::Index k = 0; k < inputs.cols(); ++k) {
    const StateBatch input = inputs.col(k);
    dynamics.step(state, input, next);
    states.col(k + 1) = next.col(0);
    state.swap(next);
  }
  return states;
}

std::vector<Eigen::MatrixXd> lqr_gains(const Dynamics& dynamics,
                                       const Eigen::Ref<const Eigen::MatrixXd>& states,
                                       const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                       const LqrWeights& weights) {
  std::vector<Eigen::MatrixXd> gains(inputs.cols());
  Eigen::MatrixXd a(states.rows(), states.rows());
  Eigen::MatrixXd b(states.rows(), inputs.rows());
  Eigen::MatrixXd value = weights.terminal;
  for (Eigen::Index k = inputs.cols() - 1; k >= 0; --k) {
    dynamics.jacobians(states.col(k), inputs.col(k), a, b);
    const Eigen::MatrixXd curvature = weights.input + b.transpose() * value * b;
    gains[k] = -curvature.ldlt().solve(b.transpose() * value * a);
    const Eigen::MatrixXd closed = a + b * gains[k];
    // Joseph's form keeps the value symmetric and positive semidefinite under rounding.
    value = weights.state + closed.transpose() * value * closed +
            gains[k].transpose() * weights.input * gains[k];
  }
  return gains;
}

}  // namespace qsmpc
