#include "harness/video/raw_points.hpp"

#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "controller/planning/policy_maker.hpp"
#include "harness/assembly/assembly.hpp"

namespace qsmpc::harness {
namespace {

controller::DiscreteMeasure noise_points(const Scenario& scenario) {
  const Eigen::MatrixXd& covariance = scenario.disturbance.covariance;
  if (!decision_parts(scenario).noise) {
    return {controller::Points::Zero(covariance.rows(), 1), Eigen::VectorXd::Ones(1)};
  }
  const controller::Gaussian noise{Eigen::VectorXd::Zero(covariance.rows()), covariance};
  return controller::quantise(noise, scenario.controller.quantisation.noise).measure;
}

}  // namespace

RawPoints::RawPoints(const Scenario& scenario)
    : model_(model_of(scenario)),
      settings_(planner_settings(scenario)),
      noise_(noise_points(scenario)) {}

std::size_t RawPoints::count(const StepRecord& step) const {
  Eigen::Index count = 0;
  for (std::size_t k = 0; k + 1 < step.particles.size(); ++k) {
    count += step.particles[k].size() * noise_.size();
  }
  return static_cast<std::size_t>(count);
}

controller::Policy RawPoints::policy_of(const StepRecord& step) const {
  controller::Policy policy{.inputs = step.plan_inputs,
                            .states = step.plan_states,
                            .gains = step.plan_gains,
                            .bounds = settings_.bounds};
  if (!policy.gains.empty()) return policy;
  // An older trace without gains: they are those that belong to the inputs.
  const Eigen::MatrixXd no_change = Eigen::MatrixXd::Zero(model_->input_dim(), model_->state_dim());
  controller::PolicyMaker(*model_, settings_)
      .make(step.plan_states.col(0), step.plan_inputs, no_change, policy);
  return policy;
}

std::vector<controller::DiscreteMeasure> RawPoints::stages(const StepRecord& step) const {
  std::vector<controller::DiscreteMeasure> stages;
  if (step.particles.empty()) return stages;
  const controller::Policy policy = policy_of(step);
  for (std::size_t k = 0; k + 1 < step.particles.size(); ++k) {
    const controller::DiscreteMeasure& before = step.particles[k];
    controller::Points inputs(model_->input_dim(), before.size());
    controller::Points stepped(before.dim(), before.size());
    controller::policy_inputs(policy, static_cast<Eigen::Index>(k), before.locations, inputs);
    model_->step(before.locations, inputs, stepped);
    controller::DiscreteMeasure raw{controller::Points(before.dim(), before.size() * noise_.size()),
                                    Eigen::VectorXd(before.size() * noise_.size())};
    for (Eigen::Index j = 0; j < noise_.size(); ++j) {
      const Eigen::Index first = j * before.size();
      raw.locations.middleCols(first, before.size()) = stepped.colwise() + noise_.locations.col(j);
      raw.weights.segment(first, before.size()) = noise_.weights[j] * before.weights;
    }
    stages.push_back(std::move(raw));
  }
  return stages;
}

}  // namespace qsmpc::harness
