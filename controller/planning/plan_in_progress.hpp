// One plan in the making, as passed between the steps of planning.
#pragma once

#include <chrono>
#include <utility>

#include "controller/planning/plan.hpp"

namespace qsmpc::controller {

/// Adds up the durations of parts of planning.
class PlanStopwatch {
 public:
  /// Adds the milliseconds since construction or the last call to `total`.
  void add_to(double& total) {
    const auto now = Clock::now();
    total += std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

struct PlanInProgress {
  using Clock = std::chrono::steady_clock;

  Plan* current = nullptr;    ///< the best so far
  Plan* candidate = nullptr;  ///< scratch plan that may replace it
  Clock::time_point deadline = Clock::time_point::max();
  bool warm = false;       ///< whether it continues the last plan
  bool evaluated = false;  ///< whether `current` has its own prediction
  bool failed = false;     ///< whether a solver found no finite cost near `current`
  SolverStatus status = SolverStatus::kConverged;  ///< of the last solver that ran
  int evaluations = 0;
  PlanTiming timing{};

  [[nodiscard]] bool stopped() const {
    return status == SolverStatus::kDeadline || status == SolverStatus::kNumericalTrouble;
  }
  [[nodiscard]] bool late() const { return Clock::now() >= deadline; }
  /// Makes the candidate the current plan.
  void accept_candidate() {
    std::swap(current, candidate);
    evaluated = true;
  }
};

}  // namespace qsmpc::controller
