// Where the optimisation of a plan starts.
//
// The cost has a valley for each way round each obstacle. The shifted previous plan is the first
// choice; constant inputs, priced on the belief's points without noise, show whether another valley
// is clearly deeper.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/planning/horizon_cost.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/planning/policy_maker.hpp"
#include "controller/prediction/prediction.hpp"

namespace qsmpc {

class FirstGuess {
 public:
  /// `terms` and all they refer to must stay alive. Its noise covariance should be zero.
  FirstGuess(const PlannerSettings& settings, const HorizonCostTerms& terms);

  /// Chooses for a belief that is represented by `points`. previous: the inputs of the previous
  /// plan, or null. Returns whether the shifted previous inputs were chosen. Allocates only for
  /// the first belief of a kind.
  bool choose(const Eigen::VectorXd& mean, const DiscreteMeasure& points,
              const Eigen::MatrixXd* previous, const Eigen::MatrixXd& gain_change,
              PolicyMaker& policies);

  /// input_dim x horizon.
  [[nodiscard]] const Eigen::MatrixXd& inputs() const { return best_; }

 private:
  [[nodiscard]] double price(const Eigen::VectorXd& mean, const Eigen::MatrixXd& inputs,
                             const Eigen::MatrixXd& gain_change, PolicyMaker& policies);

  HorizonCost cost_;
  std::vector<Eigen::MatrixXd> constants_;
  Eigen::MatrixXd shifted_;
  Eigen::MatrixXd best_;
  Eigen::VectorXd flat_;
  Policy policy_;
  Prediction noise_free_;  // of which only the sizes, the weights and the belief matter
};

/// The inputs of a plan, one stage later; the last is held.
void shift_inputs(const Eigen::MatrixXd& inputs, Eigen::MatrixXd& out);

}  // namespace qsmpc
