// A plan: the policy over the horizon, with its prediction and expected cost.
#pragma once

#include <Eigen/Core>

#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "controller/planning/cost/cost_parts.hpp"
#include "controller/planning/risk/risk_limits.hpp"
#include "controller/planning/solvers/solver_status.hpp"
#include "controller/prediction/policy.hpp"
#include "controller/prediction/prediction.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// Wall-clock times in milliseconds.
struct PlanTiming {
  double quantise = 0.0;
  double propagate = 0.0;  ///< first guesses, linearisations, predictions with new assignments
  double optimise = 0.0;   ///< inside the solver
};

struct Plan {
  Policy policy;
  Eigen::MatrixXd gain_change;  ///< input_dim x state_dim, in all gains; zero unless optimised
  GaussianQuantisation belief;  ///< of stage 0
  Prediction prediction;        ///< under `policy`, with its own assignments
  CostParts cost;               ///< of `prediction`
  /// Of the solver's last run; kDeadline: the time ran out, and this is the best so far.
  SolverStatus status = SolverStatus::kConverged;
  PlanRisk risk;           ///< of `policy`, where there are limits
  double violation = 0.0;  ///< largest distance of a particle beyond the bounds, if the
                           ///< solver takes them as constraints; else 0
  int evaluations = 0;     ///< of cost and gradient
  bool warm = false;       ///< the previous plan was the first guess
  bool fallback = false;   ///< no finite result; this is the shifted previous plan
  PlanTiming timing;
};

/// Tolerance within which a particle beyond a bound counts as inside (m, or the state's unit).
inline constexpr double kConstraintTolerance = 1e-6;

/// Whether `plan` is better than `other`: feasible before infeasible, then the cheaper; of two
/// infeasible plans, the one with the smaller violation of the bounds, then of the risk limits.
/// Anything is better than a non-finite cost.
[[nodiscard]] bool better(const Plan& plan, const Plan& other);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
