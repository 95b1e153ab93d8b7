// Cold starts among obstacles.
//
// The cost has a valley for each way round each obstacle, and a descent ends in the one in which it
// starts. Inputs that are constant over each half of the horizon are priced in all combinations;
// the best of each first half descends a little; the bottoms of different valleys are what a plan
// may start from. All of this on a handful of points that have the belief's mean and covariance,
// without noise: it is to find valleys, not to tell which of two like ones is the deeper.
#pragma once

#include <chrono>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/planning/horizon_cost.hpp"
#include "controller/planning/ocp_solver.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/planning/policy_maker.hpp"
#include "controller/prediction/prediction.hpp"

namespace qsmpc {

class ValleySearch {
 public:
  /// `terms` and all they refer to must stay alive. Their covariances should be zero.
  ValleySearch(const PlannerSettings& settings, const HorizonCostTerms& terms);

  /// Inputs (input_dim x horizon, within the bounds) in different valleys, the cheapest first; at
  /// least one set of inputs, even after `deadline`. Valid until the next search. Allocates only
  /// where the belief's covariance is another one than before.
  const std::vector<const Eigen::MatrixXd*>& search(const Gaussian& belief, PolicyMaker& policies,
                                                    std::chrono::steady_clock::time_point deadline);

 private:
  struct Start {
    Eigen::MatrixXd inputs;
    int group = 0;  // starts of one group differ in the second half alone
    double cost = 0.0;
  };

  void place_points(const Gaussian& belief);
  void hold(const Eigen::VectorXd& mean, const Eigen::MatrixXd& inputs, PolicyMaker& policies);
  void descend(const Eigen::VectorXd& mean, PolicyMaker& policies, Start& start);

  HorizonCost cost_;
  OcpProblem problem_;
  std::unique_ptr<OcpSolver> solver_;
  Eigen::MatrixXd no_gain_change_;
  std::vector<Eigen::MatrixXd> candidates_;
  std::vector<int> candidate_groups_;
  std::vector<Start> starts_;  // the best of each group
  std::vector<Start*> order_;
  std::vector<const Eigen::MatrixXd*> valleys_;
  Eigen::MatrixXd covariance_;  // that `offsets_` belong to
  Eigen::MatrixXd offsets_;     // of the points from the mean
  Prediction noise_free_;       // of which only the sizes, the weights and the belief matter
  Policy policy_;
  Eigen::VectorXd z_;
};

}  // namespace qsmpc
