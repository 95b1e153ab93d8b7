// Policies about given nominal inputs, with the gains defined by the settings.
#pragma once

#include <Eigen/Core>

#include "controller/planning/planner_settings.hpp"
#include "controller/prediction/policy.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

class PolicyMaker {
 public:
  /// Keeps references to both.
  PolicyMaker(const models::Dynamics& dynamics, const PlannerSettings& settings);

  /// The policy about the noise-free trajectory from `start` (state_dim) under `inputs` (input_dim
  /// x horizon), with `gain_change` (input_dim x state_dim) added to the gains of all stages;
  /// written to `out`, whose storage is reused.
  void make(const Eigen::Ref<const Eigen::VectorXd>& start,
            const Eigen::Ref<const Eigen::MatrixXd>& inputs, const Eigen::MatrixXd& gain_change,
            Policy& out);

  /// Sets the factor on the input weight in the LQR of the gains, relative to the cost; > 0.
  void set_effort(double effort);

 private:
  const models::Dynamics& dynamics_;
  const PlannerSettings& settings_;
  LqrWeights weights_;
  LqrScratch scratch_;
};

}  // namespace qsmpc::controller
