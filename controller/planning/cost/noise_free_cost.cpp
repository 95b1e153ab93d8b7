#include "controller/planning/cost/noise_free_cost.hpp"

#include <cmath>
#include <limits>

#include "models/linear_algebra.hpp"

namespace qsmpc::controller {

NoiseFreeCost::NoiseFreeCost(int horizon, const HorizonCostTerms& terms) : cost_(terms) {
  const Eigen::Index dim = terms.cost.state.rows();
  const Eigen::Index points = 2 * dim;
  noise_free_.stages.resize(horizon + 1);
  for (DiscreteMeasure& stage : noise_free_.stages) {
    stage.locations.resize(dim, points);
    stage.weights.setConstant(points, 1.0 / static_cast<double>(points));
  }
  noise_free_.maps.resize(horizon);
  for (StageMap& map : noise_free_.maps) {
    map.identity = true;
    map.weights = noise_free_.stages[0].weights;
  }
}

void NoiseFreeCost::place(const Gaussian& belief) {
  const Eigen::Index dim = belief.mean.size();
  if (covariance_.size() == 0 || covariance_ != belief.covariance) {
    covariance_ = belief.covariance;
    const models::SymmetricEigen eigen = models::symmetric_eigen(covariance_);
    const Eigen::VectorXd reach =
        (static_cast<double>(dim) * eigen.values.cwiseMax(0.0)).cwiseSqrt();
    offsets_.resize(dim, 2 * dim);
    offsets_.leftCols(dim) = eigen.vectors * reach.asDiagonal();
    offsets_.rightCols(dim) = -offsets_.leftCols(dim);
  }
  mean_ = belief.mean;
  noise_free_.stages[0].locations = offsets_.colwise() + belief.mean;
}

void NoiseFreeCost::freeze_assignments(const Eigen::MatrixXd& inputs,
                                       const Eigen::MatrixXd& gain_change, PolicyMaker& policies) {
  policies.make(mean_, inputs, gain_change, policy_);
  cost_.freeze_assignments(noise_free_, policy_);
}

double NoiseFreeCost::evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& gradient) {
  const double cost = cost_.evaluate(z, gradient);
  return excess_ ? cost + excess_(z, excess_weight_, &gradient) : cost;
}

double NoiseFreeCost::evaluate(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& gain_change,
                               PolicyMaker& policies) {
  freeze_assignments(inputs, gain_change, policies);
  z_ = inputs.reshaped();
  double cost = cost_.evaluate(z_);
  if (excess_) cost += excess_(z_, excess_weight_, nullptr);
  return std::isnan(cost) ? std::numeric_limits<double>::infinity() : cost;
}

}  // namespace qsmpc::controller
