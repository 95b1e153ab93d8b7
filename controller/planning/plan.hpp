// A plan: the policy over the horizon, and what is predicted and expected of it.
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
  /// Of the solver's last run; kDeadline where the time was up, this being the best so far.
  SolverStatus status = SolverStatus::kConverged;
  PlanRisk risk;           ///< of `policy`, where there are limits
  double violation = 0.0;  ///< how far a particle is beyond the bounds at most, where the solver
                           ///< takes them as constraints; 0 elsewhere
  int evaluations = 0;     ///< of cost and gradient
  bool warm = false;       ///< the previous plan was the first guess
  bool fallback = false;   ///< nothing finite came out; this is the shifted previous plan
  PlanTiming timing;
};

/// How far a particle may be beyond a bound (m, or the state's unit) and still count as within.
inline constexpr double kConstraintTolerance = 1e-6;

/// Whether `plan` is better than `other`: feasible before infeasible, then the cheaper; of two that
/// are infeasible the nearer, by the bounds first and then by the risk. Anything is better than a
/// cost that is not finite.
[[nodiscard]] bool better(const Plan& plan, const Plan& other);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
