// The predicted motion under any controller's decision, in the form that certificates need.
#pragma once

#include <memory>

#include <Eigen/Core>

#include "controller/control/controller.hpp"
#include "controller/planning/belief_quantiser.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/prediction/propagator.hpp"
#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

class DecisionMotion {
 public:
  /// `dynamics` must outlive it. settings: how beliefs are quantised and propagated for controllers
  /// that give no particles. Throws std::invalid_argument on invalid ones.
  DecisionMotion(const models::Dynamics& dynamics, const PlannerSettings& settings);

  /// The motion over the stages of the decision's policy, from the situation's belief, with the
  /// controller's particles or, if it has none, with particles made here. Without a policy: only
  /// the motion to the next state, from `posterior`, the law of the state given the observation, on
  /// which the input may depend in any way. Refers to all arguments and to this object; valid until
  /// the next call.
  [[nodiscard]] PredictedMotion of(const Situation& situation, const Decision& decision,
                                   const Gaussian& posterior);

 private:
  [[nodiscard]] PredictedMotion predicted(const Gaussian& belief, const Policy& policy);

  const models::Dynamics& dynamics_;
  Eigen::MatrixXd noise_covariance_;
  InputBounds bounds_;
  Executor run_;
  BeliefQuantiser quantiser_;
  std::unique_ptr<Propagator> propagator_;
  PredictionScratch scratch_;
  GaussianQuantisation belief_;
  Prediction prediction_;
  Policy one_stage_;
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
