// What inputs would cost without noise, on a handful of points in place of the belief: cheap, and
// good enough to find where a plan may start.
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
  /// `terms` and all they refer to must stay alive. Their covariances should be zero.
  NoiseFreeCost(int horizon, const HorizonCostTerms& terms);

  /// From now on, inputs are evaluated for this belief: on the 2 · state_dim points ±√d σ_i e_i
  /// about its mean, with e_i and σ_i² the eigenvectors and eigenvalues of its covariance, which
  /// have its mean and covariance. Allocates only where the covariance is another one than before.
  void place(const Gaussian& belief);

  /// Makes `cost` that of the policy about `inputs` (input_dim x horizon) with the gains that the
  /// policies' maker and `gain_change` (input_dim x state_dim) say.
  void freeze_assignments(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& gain_change,
                          PolicyMaker& policies);

  /// The cost of the policy that is held for a decision like HorizonCost's, with its gradient.
  double evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& gradient);

  /// From now on `excess` is added to the cost, times `weight`; none if empty. It gets a decision,
  /// and a gradient to add to or null.
  using Excess =
      std::function<double(const Eigen::VectorXd& z, double weight, Eigen::VectorXd* gradient)>;
  void set_excess(Excess excess) { excess_ = std::move(excess); }
  void set_excess_weight(double weight) { excess_weight_ = weight; }

  /// As `freeze_assignments`; returns the cost, infinity instead of what is not a number, so that
  /// it loses every comparison.
  [[nodiscard]] double evaluate(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& gain_change,
                                PolicyMaker& policies);

 private:
  HorizonCost cost_;
  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;  // that `offsets_` belong to
  Eigen::MatrixXd offsets_;     // of the points from the mean
  Prediction noise_free_;       // of which only the sizes, the weights and the belief matter
  Policy policy_;
  Eigen::VectorXd z_;
  Excess excess_;
  double excess_weight_ = 0.0;
};

}  // namespace qsmpc::controller
