#include "controller/prediction/policy.hpp"

namespace qsmpc::controller {

Eigen::VectorXd policy_input(const Policy& policy, Eigen::Index stage,
                             const Eigen::Ref<const Eigen::VectorXd>& state) {
  Eigen::VectorXd offset;
  Eigen::VectorXd input;
  policy_input(policy, stage, state, offset, input);
  return input;
}

void policy_input(const Policy& policy, Eigen::Index stage,
                  const Eigen::Ref<const Eigen::VectorXd>& state, Eigen::VectorXd& offset,
                  Eigen::VectorXd& input) {
  offset = state - policy.states.col(stage);
  input = policy.inputs.col(stage);
  input.noalias() += policy.gains[stage] * offset;
  input = input.cwiseMax(policy.bounds.lower).cwiseMin(policy.bounds.upper);
}

void policy_inputs(const Policy& policy, Eigen::Index stage,
                   const models::Dynamics::BatchView& states, models::Dynamics::BatchOut out) {
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

void nominal_states(const models::Dynamics& dynamics,
                    const Eigen::Ref<const Eigen::VectorXd>& start,
                    const Eigen::Ref<const Eigen::MatrixXd>& inputs, Eigen::MatrixXd& out) {
  out.resize(start.size(), inputs.cols() + 1);
  out.col(0) = start;
  for (Eigen::Index k = 0; k < inputs.cols(); ++k) {
    using View = Eigen::Map<const models::StateBatch>;
    dynamics.step(View(out.col(k).data(), out.rows(), 1),
                  View(inputs.col(k).data(), inputs.rows(), 1),
                  Eigen::Map<models::StateBatch>(out.col(k + 1).data(), out.rows(), 1));
  }
}

Eigen::MatrixXd nominal_states(const models::Dynamics& dynamics,
                               const Eigen::Ref<const Eigen::VectorXd>& start,
                               const Eigen::Ref<const Eigen::MatrixXd>& inputs) {
  Eigen::MatrixXd states;
  nominal_states(dynamics, start, inputs, states);
  return states;
}

void lqr_gains(const models::Dynamics& dynamics, const Eigen::Ref<const Eigen::MatrixXd>& states,
               const Eigen::Ref<const Eigen::MatrixXd>& inputs, const LqrWeights& weights,
               LqrScratch& scratch, std::vector<Eigen::MatrixXd>& gains) {
  LqrScratch& s = scratch;
  s.a.resize(states.rows(), states.rows());
  s.b.resize(states.rows(), inputs.rows());
  gains.resize(inputs.cols());
  s.value = weights.terminal;
  for (Eigen::Index k = inputs.cols() - 1; k >= 0; --k) {
    dynamics.jacobians(states.col(k), inputs.col(k), s.a, s.b);
    Eigen::MatrixXd& gain = gains[k];
    s.cross.noalias() = s.b.transpose() * s.value;
    s.curvature = weights.input;
    s.curvature.noalias() += s.cross * s.b;
    s.ldlt.compute(s.curvature);
    gain.noalias() = s.cross * s.a;
    s.ldlt.solveInPlace(gain);
    gain *= -1.0;
    // Joseph's form keeps the value symmetric and positive semidefinite under rounding.
    s.closed = s.a;
    s.closed.noalias() += s.b * gain;
    s.product.noalias() = s.value * s.closed;
    s.value = weights.state;
    s.value.noalias() += s.closed.transpose() * s.product;
    s.cross.noalias() = weights.input * gain;
    s.value.noalias() += gain.transpose() * s.cross;
  }
}

std::vector<Eigen::MatrixXd> lqr_gains(const models::Dynamics& dynamics,
                                       const Eigen::Ref<const Eigen::MatrixXd>& states,
                                       const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                       const LqrWeights& weights) {
  LqrScratch scratch;
  std::vector<Eigen::MatrixXd> gains;
  lqr_gains(dynamics, states, inputs, weights, scratch, gains);
  return gains;
}

}  // namespace qsmpc::controller
