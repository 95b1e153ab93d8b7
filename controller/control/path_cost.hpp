// The cost of a noise-free path, for controllers that plan one.
#pragma once

#include <Eigen/Core>

#include "controller/planning/cost/cost_parts.hpp"
#include "controller/planning/cost/horizon_cost.hpp"
#include "controller/prediction/policy.hpp"

namespace qsmpc::controller {

/// Scratch; reused, only the first path allocates.
struct PathCostScratch {
  Eigen::VectorXd away;
  Eigen::VectorXd weighted_state;
  Eigen::VectorXd weighted_input;
};

/// The parts "state", "input" and "terminal" of the cost of a policy's nominal states and inputs.
[[nodiscard]] CostParts path_cost(const Policy& path, const QuadraticCost& cost,
                                  PathCostScratch& scratch);

}  // namespace qsmpc::controller
