// The exact expected cost of the Dubins car in open loop, and the inputs that make it least.
//
//   x⁺ = x + s cos φ + w_x,  y⁺ = y + s sin φ + w_y,  φ⁺ = φ + T u + w_φ
//
// with s the reach of a period, from a Gaussian, under Gaussian noise. The headings of all stages
// and the positions' own noise are jointly Gaussian, so that the first two moments of the state are
// finite sums of E e^{iaφ}, E e^{i(aφ_j + bφ_l)} and E g e^{iaφ}, each known exactly. No particle,
// no sample: what a planner reaches can be held against this. Without obstacles and penalties.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/planning/cost/horizon_cost.hpp"
#include "controller/prediction/policy.hpp"

namespace qsmpc::testing {

struct DubinsProblem {
  double speed = 1.5;           ///< m/s
  double time_step = 0.1;       ///< s
  controller::Gaussian belief;  ///< of (x, y, φ) at stage 0; any covariance
  Eigen::Matrix3d noise_covariance;
  controller::QuadraticCost cost;
  controller::InputBounds bounds;  ///< of the yaw rate
};

/// E xᵀ and E x xᵀ of the state at one stage.
struct DubinsMoments {
  Eigen::Vector3d mean;
  Eigen::Matrix3d second;
};

/// Stages 0 … inputs.cols() under the yaw rates `inputs` (1 x horizon), which are applied as they
/// are.
[[nodiscard]] std::vector<DubinsMoments> dubins_moments(
    const DubinsProblem& problem, const Eigen::Ref<const Eigen::MatrixXd>& inputs);

/// J of docs/theory/planning.md without penalties, exactly: the parts state, input and terminal.
[[nodiscard]] controller::CostParts dubins_cost(const DubinsProblem& problem,
                                                const Eigen::Ref<const Eigen::MatrixXd>& inputs);

struct DubinsOptimum {
  Eigen::MatrixXd inputs;  ///< 1 x horizon
  double cost = 0.0;
};

/// The least of `dubins_cost` over the bounds: the best that SLSQP finds from `starts` starts, the
/// constant inputs at the bounds and at zero and random ones, each to the last digits.
[[nodiscard]] DubinsOptimum dubins_optimum(const DubinsProblem& problem, int horizon,
                                           int starts = 20);

}  // namespace qsmpc::testing
