#include "controller/planning/horizon_cost.hpp"

#include <algorithm>
#include <utility>

namespace qsmpc {
namespace {

/// Σ_i ρ_i (x_i − r)ᵀW(x_i − r); `weighted` receives W(x_i − r).
double expected_quadratic(const Points& points, const Eigen::VectorXd& weights,
                          const Eigen::MatrixXd& matrix, const Eigen::VectorXd& centre,
                          Points& weighted) {
  double sum = 0.0;
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    auto out = weighted.row(row).array();
    out = 0.0;
    for (Eigen::Index column = 0; column < points.rows(); ++column) {
      const double entry = matrix(row, column);
      if (entry != 0.0) out += entry * (points.row(column).array() - centre[column]);
    }
    sum += (weights.transpose().array() * out * (points.row(row).array() - centre[row])).sum();
  }
  return sum;
}

/// adjoint += factor · ρ_i · weighted_i.
void add_weighted(double factor, const Eigen::VectorXd& weights, const Points& weighted,
                  Points& adjoint) {
  for (Eigen::Index row = 0; row < adjoint.rows(); ++row) {
    adjoint.row(row).array() += factor * weights.transpose().array() * weighted.row(row).array();
  }
}

}  // namespace

HorizonCost::HorizonCost(HorizonCostTerms terms, const Prediction& prediction, const Policy& policy)
    : terms_(terms),
      prediction_(prediction),
      policy_(policy),
      zero_input_(Eigen::VectorXd::Zero(policy.inputs.rows())),
      stages_(policy.horizon() + 1) {
  const Eigen::Index dim = policy.states.rows();
  const Eigen::Index inputs = policy.inputs.rows();
  for (Eigen::Index k = 0; k <= policy.horizon(); ++k) {
    const Eigen::Index size = prediction.stages[k].size();
    Stage& stage = stages_[k];
    for (Points* points :
         {&stage.adjoint, &stage.stepped, &stage.stepped_adjoint, &stage.weighted}) {
      points->resize(dim, size);
    }
    for (Points* points : {&stage.inputs, &stage.input_adjoint, &stage.weighted_inputs}) {
      points->resize(inputs, size);
    }
    stage.points = prediction.stages[k].locations;
    nominal_.emplace_back(policy.states.col(k));
  }
  nominal_adjoint_.resize(dim, 1);
  nominal_step_adjoint_.resize(dim, 1);
  nominal_input_.resize(inputs, 1);
  nominal_input_adjoint_.resize(inputs, 1);

  const QuadraticCost& cost = terms_.cost;
  const double noise = cost.state.cwiseProduct(terms_.noise_covariance).sum();
  const Points& belief = stages_[0].points;
  constant_state_cost_ = 0.5 * (expected_quadratic(belief, prediction.stages[0].weights, cost.state,
                                                   cost.target, stages_[0].weighted) +
                                cost.state.cwiseProduct(terms_.within_covariance).sum() +
                                static_cast<double>(policy.horizon() - 1) * noise);
  constant_terminal_cost_ = cost.terminal.cwiseProduct(terms_.noise_covariance).sum();
}

double HorizonCost::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                             Eigen::MatrixXd& gradient) {
  forward(inputs);
  backward(gradient);
  return parts_.total();
}

void HorizonCost::forward(const Eigen::Ref<const Eigen::MatrixXd>& inputs) {
  const QuadraticCost& cost = terms_.cost;
  const Eigen::Index horizon = policy_.horizon();
  policy_.inputs = inputs;
  parts_ = {.state = constant_state_cost_, .terminal = constant_terminal_cost_};
  for (Eigen::Index k = 0; k < horizon; ++k) {
    Stage& stage = stages_[k];
    const Eigen::VectorXd& weights = prediction_.stages[k].weights;
    nominal_input_ = inputs.col(k);
    terms_.dynamics.step(nominal_[k], nominal_input_, nominal_[k + 1]);
    policy_.states.col(k + 1) = nominal_[k + 1];
    policy_inputs(policy_, k, stage.points, stage.inputs);
    parts_.input +=
        expected_quadratic(stage.inputs, weights, cost.input, zero_input_, stage.weighted_inputs);
    terms_.dynamics.step(stage.points, stage.inputs, stage.stepped);
    const bool last = k + 1 == horizon;
    const double squares = expected_quadratic(
        stage.stepped, weights, last ? cost.terminal : cost.state, cost.target, stage.weighted);
    (last ? parts_.terminal : parts_.state) += last ? squares : 0.5 * squares;

    Stage& next = stages_[k + 1];
    apply_stage_map(prediction_.maps[k], stage.stepped, next.points);
    next.adjoint.setZero();
    const PenaltyValue penalty = add_penalty(next.points, prediction_.maps[k].weights,
                                             terms_.safe_set, terms_.penalty, next.adjoint);
    parts_.box += penalty.box;
    parts_.obstacle += penalty.obstacle;
  }
}

void HorizonCost::backward(Eigen::MatrixXd& gradient) {
  gradient.setZero();
  nominal_adjoint_.setZero();
  stages_[0].adjoint.setZero();
  const Eigen::Index horizon = policy_.horizon();
  for (Eigen::Index k = horizon - 1; k >= 0; --k) {
    Stage& stage = stages_[k];
    const Eigen::VectorXd& weights = prediction_.stages[k].weights;
    pullback_stage_map(prediction_.maps[k], stages_[k + 1].adjoint, stage.stepped_adjoint);
    add_weighted(k + 1 == horizon ? 2.0 : 1.0, weights, stage.weighted, stage.stepped_adjoint);
    // `weighted` has served: it takes the pulled-back adjoint, which is added to the penalty's.
    terms_.dynamics.pullback(stage.points, stage.inputs, stage.stepped_adjoint, stage.weighted,
                             stage.input_adjoint);
    stage.adjoint += stage.weighted;
    add_weighted(2.0, weights, stage.weighted_inputs, stage.input_adjoint);
    backward_policy(k, gradient);
  }
}

void HorizonCost::backward_policy(Eigen::Index k, Eigen::MatrixXd& gradient) {
  Stage& stage = stages_[k];
  const Eigen::MatrixXd& gain = policy_.gains[k];
  // Through the nominal step: x̄_{k+1} = f(x̄_k, v_k).
  nominal_input_ = policy_.inputs.col(k);
  nominal_step_adjoint_ = nominal_adjoint_;
  terms_.dynamics.pullback(nominal_[k], nominal_input_, nominal_step_adjoint_, nominal_adjoint_,
                           nominal_input_adjoint_);
  gradient.col(k) = nominal_input_adjoint_;
  // Through the clamp, whose slope is 1 strictly inside the bounds and 0 where it saturates.
  for (Eigen::Index input = 0; input < gain.rows(); ++input) {
    const double lower = policy_.bounds.lower[input];
    const double upper = policy_.bounds.upper[input];
    auto adjoint = stage.input_adjoint.row(input).array();
    const auto value = stage.inputs.row(input).array();
    if (!gain.row(input).isZero(0.0)) {
      adjoint = ((value > lower) && (value < upper)).select(adjoint, 0.0);
    }
    const double sum = adjoint.sum();
    gradient(input, k) += sum;
    for (Eigen::Index axis = 0; axis < gain.cols(); ++axis) {
      if (gain(input, axis) == 0.0) continue;
      stage.adjoint.row(axis).array() += gain(input, axis) * adjoint;
      nominal_adjoint_(axis, 0) -= gain(input, axis) * sum;
    }
  }
}

}  // namespace qsmpc
