// The exact expected cost of the Dubins car in open loop, and the inputs that minimise it.
//
//   x⁺ = x + s cos φ + w_x,  y⁺ = y + s sin φ + w_y,  φ⁺ = φ + T u + w_φ
//
// with s the distance covered in a period, from a Gaussian belief, under Gaussian noise. The
// headings of all stages and the positions' own noise are jointly Gaussian, so the first two
// moments of the state are finite sums of E e^{iaφ}, E e^{i(aφ_j + bφ_l)} and E g e^{iaφ}, each
// known exactly. No particles, no samples: a reference for the planner's results. No obstacles, no
// penalties.
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

/// E x and E x xᵀ of the state at one stage.
struct DubinsMoments {
  Eigen::Vector3d mean;
  Eigen::Matrix3d second;
};

/// Moments at stages 0 … inputs.cols() under the yaw rates `inputs` (1 x horizon), applied
/// unclamped.
[[nodiscard]] std::vector<DubinsMoments> dubins_moments(
    const DubinsProblem& problem, const Eigen::Ref<const Eigen::MatrixXd>& inputs);

/// J of docs/theory/planning.md without penalties, exactly: its state, input and terminal parts.
[[nodiscard]] controller::CostParts dubins_cost(const DubinsProblem& problem,
                                                const Eigen::Ref<const Eigen::MatrixXd>& inputs);

struct DubinsOptimum {
  Eigen::MatrixXd inputs;  ///< 1 x horizon
  double cost = 0.0;
};

/// The minimum of `dubins_cost` within the bounds: the best result of SLSQP from `starts` starts
/// (constant inputs at the bounds and at zero, and random ones), each run to the last digits.
[[nodiscard]] DubinsOptimum dubins_optimum(const DubinsProblem& problem, int horizon,
                                           int starts = 20);

}  // namespace qsmpc::testing
