#include "controller/planning/policy_maker.hpp"

namespace qsmpc::controller {

// The curvature of the cost: ½ x'Qx, u'Ru and x'Px have the Hessians Q, 2R and 2P.
PolicyMaker::PolicyMaker(const models::Dynamics& dynamics, const PlannerSettings& settings)
    : dynamics_(dynamics),
      settings_(settings),
      weights_{.state = settings.cost.state,
               .input = 2.0 * settings.cost.input,
               .terminal = 2.0 * settings.cost.terminal} {
  set_effort(settings.feedback_effort.value_or(1.0));
}

void PolicyMaker::set_effort(double effort) {
  weights_.input = 2.0 * effort * settings_.cost.input;
}

void PolicyMaker::make(const Eigen::Ref<const Eigen::VectorXd>& start,
                       const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                       const Eigen::MatrixXd& gain_change, Policy& out) {
  out.inputs = inputs;
  out.bounds = settings_.bounds;
  nominal_states(dynamics_, start, inputs, out.states);
  out.gains.resize(inputs.cols());
  if (!settings_.closed_loop) {
    for (Eigen::MatrixXd& gain : out.gains) gain.setZero(inputs.rows(), start.size());
    return;
  }
  if (settings_.feedback_gain) {
    for (Eigen::MatrixXd& gain : out.gains) gain = *settings_.feedback_gain;
  } else {
    lqr_gains(dynamics_, out.states, inputs, weights_, scratch_, out.gains);
  }
  for (Eigen::MatrixXd& gain : out.gains) gain += gain_change;
}

}  // namespace qsmpc::controller
