// The cost function for a solver: counts evaluations, enforces the limits, and checks for
// non-finite values.
#pragma once

#include <chrono>
#include <cmath>
#include <optional>

#include <Eigen/Core>

#include "controller/planning/solvers/ocp_solver.hpp"

namespace qsmpc::controller {

class MeteredCost {
 public:
  /// Keeps references to both.
  MeteredCost(const OcpProblem& problem, const SolverOptions& options)
      : problem_(problem), options_(options) {}

  /// Value and gradient at `z`. Returns false, then and ever after, if the evaluations or the time
  /// are used up, or the result is not finite; `stopped` says which. Allocates nothing.
  bool evaluate(const Eigen::VectorXd& z, double& value, Eigen::VectorXd& gradient) {
    if (!stopped_ && evaluations_ >= options_.max_evaluations) {
      stopped_ = SolverStatus::kIterationLimit;
    }
    if (!stopped_ && late()) stopped_ = SolverStatus::kDeadline;
    if (stopped_) return false;
    value = problem_.cost(z, gradient);
    ++evaluations_;
    if (!std::isfinite(value) || !gradient.allFinite()) stopped_ = SolverStatus::kNumericalTrouble;
    return !stopped_;
  }

  [[nodiscard]] int evaluations() const { return evaluations_; }
  [[nodiscard]] const std::optional<SolverStatus>& stopped() const { return stopped_; }

 private:
  [[nodiscard]] bool late() const {
    // Without a deadline the clock is not read.
    return options_.deadline != std::chrono::steady_clock::time_point::max() &&
           std::chrono::steady_clock::now() >= options_.deadline;
  }

  const OcpProblem& problem_;
  const SolverOptions& options_;
  int evaluations_ = 0;
  std::optional<SolverStatus> stopped_;
};

}  // namespace qsmpc::controller
