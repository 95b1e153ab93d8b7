// The cost of inputs without noise, on a few points in place of the belief: cheap, and good enough
// to find starts for a plan.
#pragma once

#include <functional>
#include <utility>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/planning/cost/horizon_cost.hpp"
#include "controller/planning/policy_maker.hpp"
#include "controller/prediction/prediction.hpp"

namespace qsmpc::controller {

class NoiseFreeCost {
 public:
  /// Everything that `terms` refers to must stay alive. Their covariances should be zero.
  NoiseFreeCost(int horizon, const HorizonCostTerms& terms);

  /// Sets the belief for which inputs are evaluated: on the 2 · state_dim points ±√d σ_i e_i about
  /// its mean, where e_i and σ_i² are the eigenvectors and eigenvalues of its covariance; the
  /// points match its mean and covariance. Allocates only when the covariance has changed.
  void place(const Gaussian& belief);

  /// Holds the policy about `inputs` (input_dim x horizon), with the gains of `policies` plus
  /// `gain_change` (input_dim x state_dim).
  void freeze_assignments(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& gain_change,
                          PolicyMaker& policies);

  /// The cost of the held policy for a decision as in HorizonCost, with its gradient.
  double evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& gradient);

  /// Sets a function, scaled by `weight`, to add to the cost; none if empty. It gets a decision,
  /// and a gradient to add to, or null.
  using Excess =
      std::function<double(const Eigen::VectorXd& z, double weight, Eigen::VectorXd* gradient)>;
  void set_excess(Excess excess) { excess_ = std::move(excess); }
  void set_excess_weight(double weight) { excess_weight_ = weight; }

  /// As `freeze_assignments`; returns the cost, with NaN replaced by infinity, so that it loses
  /// every comparison.
  [[nodiscard]] double evaluate(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& gain_change,
                                PolicyMaker& policies);

 private:
  HorizonCost cost_;
  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;  // of which `offsets_` are
  Eigen::MatrixXd offsets_;     // of the points from the mean
  Prediction noise_free_;       // only its sizes, weights and belief are used
  Policy policy_;
  Eigen::VectorXd z_;
  Excess excess_;
  double excess_weight_ = 0.0;
};

}  // namespace qsmpc::controller
