// Multi-start search for cold starts among obstacles.
//
// The cost has a local minimum for each way round each obstacle, and a descent finds the one in
// whose basin it starts. All combinations of inputs that are constant over each half of the horizon
// are evaluated; the best for each first half descends a little; distinct local minima become the
// candidates for a plan's start. The search ignores the noise: it finds minima, but does not decide
// which of two similar ones is lower.
#pragma once

#include <chrono>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "controller/planning/cost/noise_free_cost.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/planning/policy_maker.hpp"
#include "controller/planning/solvers/ocp_solver.hpp"

namespace qsmpc::controller {

class MultiStartSearch {
 public:
  /// `cost` must stay alive.
  MultiStartSearch(const PlannerSettings& settings, NoiseFreeCost& cost);

  /// Inputs (input_dim x horizon, within the bounds) near distinct local minima of the cost, for
  /// the belief at which it has been placed, the cheapest first; at least one set of inputs, even
  /// after `deadline`. Valid until the next search.
  const std::vector<const Eigen::MatrixXd*>& search(PolicyMaker& policies,
                                                    std::chrono::steady_clock::time_point deadline);

 private:
  struct Start {
    Eigen::MatrixXd inputs;
    int group = 0;  // starts of one group differ only in the second half
    double cost = 0.0;
  };

  void descend(PolicyMaker& policies, Start& start);

  NoiseFreeCost& cost_;
  OcpProblem problem_;
  std::unique_ptr<OcpSolver> solver_;
  Eigen::MatrixXd no_gain_change_;
  std::vector<Eigen::MatrixXd> candidates_;
  std::vector<int> candidate_groups_;
  std::vector<Start> starts_;  // the best of each group
  std::vector<Start*> order_;
  std::vector<const Eigen::MatrixXd*> minima_;
  Eigen::VectorXd z_;
};

}  // namespace qsmpc::controller
