// How an optimisation ended.
#pragma once

#pragma GCC visibility push(default)

namespace qsmpc::controller {

enum class SolverStatus {
  kConverged,         ///< a tolerance was met
  kIterationLimit,    ///< best point within the allowed evaluations
  kStalled,           ///< the line search found no further descent; best point so far
  kDeadline,          ///< the time ran out; best point so far
  kInfeasible,        ///< the best point violates a constraint by more than the tolerance
  kRiskExceeded,      ///< of a plan: its certificate is above a limit, and no better one was found
  kNumericalTrouble,  ///< something was not finite; best finite point so far
};

/// "converged", "iteration_limit", "stalled", "deadline", "infeasible", "risk_exceeded" or
/// "numerical_trouble".
[[nodiscard]] const char* solver_status_name(SolverStatus status);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
