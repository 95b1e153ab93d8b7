// Where the optimisation of a plan starts.
//
// The cost has a local minimum for each way round each obstacle. The shifted previous plan is the
// first choice; constant inputs, evaluated without noise, show whether another minimum may be
// clearly lower.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "controller/planning/cost/noise_free_cost.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/planning/policy_maker.hpp"

namespace qsmpc::controller {

class FirstGuess {
 public:
  explicit FirstGuess(const PlannerSettings& settings);

  /// Compares the candidates by `cost`, which has been placed at the belief. previous: the inputs
  /// of the previous plan, or null. Returns whether they exist and have a finite cost. Allocates
  /// only in the first call.
  [[nodiscard]] bool compare(const Eigen::MatrixXd* previous, const Eigen::MatrixXd& gain_change,
                             NoiseFreeCost& cost, PolicyMaker& policies);

  /// The previous inputs shifted by one stage, and the cheapest constant inputs; input_dim x
  /// horizon.
  [[nodiscard]] const Eigen::MatrixXd& shifted() const { return shifted_; }
  [[nodiscard]] const Eigen::MatrixXd& constant() const { return constants_[constant_]; }
  /// The constant inputs in the middle of the bounds.
  [[nodiscard]] const Eigen::MatrixXd& middle() const { return constants_.front(); }
  /// By how much the constant inputs are cheaper than the shifted previous ones, without noise.
  [[nodiscard]] double advantage() const { return advantage_; }

 private:
  std::vector<Eigen::MatrixXd> constants_;
  std::size_t constant_ = 0;
  double advantage_ = 0.0;
  Eigen::MatrixXd shifted_;
};

/// Whether `cost` is so much below `than`, that of the shifted previous plan, that the latter is
/// worth abandoning: switching sides of an obstacle for less makes the vehicle waver.
[[nodiscard]] bool clearly_cheaper(double cost, double than);

/// Shifts the inputs of a plan by one stage; the last is held.
void shift_inputs(const Eigen::MatrixXd& inputs, Eigen::MatrixXd& out);

}  // namespace qsmpc::controller
