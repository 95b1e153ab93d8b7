// What a drive's certificates come to, held against the limits of its scenario (`risk`).
#pragma once

#include <limits>

#include "harness/trace/trace.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// One limit, and what is certified of what it limits.
struct CertifiedRisk {
  double limit = std::numeric_limits<double>::infinity();  ///< infinite for none
  double certified = 0.0;  ///< an upper bound of a probability; the largest, of many
  int exceeded = 0;        ///< periods in which it is above the limit

  [[nodiscard]] bool is_limited() const { return limit < std::numeric_limits<double>::infinity(); }
};

struct RiskUse {
  CertifiedRisk stage;  ///< of each stage of a period's plan
  CertifiedRisk plan;   ///< of their sum, at most 1
  /// Of the sum of the next steps' certificates up to a period, not capped; of all when the drive
  /// has ended.
  CertifiedRisk mission;
  /// Periods in which any limit is exceeded: by the period's plan (exceeds_limits), or by the drive
  /// up to its end.
  int exceeded_periods = 0;

  [[nodiscard]] bool any_limit() const {
    return stage.is_limited() || plan.is_limited() || mission.is_limited();
  }
};

/// Of a drive that makes no plans a period's plan is its next step. By the certificates in the
/// trace, which are never above those that the planner kept to its limits.
[[nodiscard]] RiskUse risk_use(const Trace& trace);

/// Whether a period's plan exceeds a limit: by its status (`risk_exceeded`), where the planner
/// keeps to limits, or by its certificates. The mission's limit counts in the status alone.
[[nodiscard]] bool exceeds_limits(const StepRecord& step, const Scenario::Risk& limits);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
