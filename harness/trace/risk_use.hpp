// A drive's certificates compared with the limits of its scenario (`risk`).
#pragma once

#include <limits>

#include "harness/trace/trace.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// One limit, and the certified bound of the probability that it limits.
struct CertifiedRisk {
  double limit = std::numeric_limits<double>::infinity();  ///< infinite for none
  double certified = 0.0;  ///< an upper bound of a probability; the maximum if there are several
  int exceeded = 0;        ///< number of periods in which the bound is above the limit

  [[nodiscard]] bool is_limited() const { return limit < std::numeric_limits<double>::infinity(); }
};

struct RiskUse {
  CertifiedRisk stage;  ///< each stage of a period's plan
  CertifiedRisk plan;   ///< their sum, capped at 1
  /// The sum of the next-step certificates up to a period, not capped; at the end of a drive, over
  /// all of its periods.
  CertifiedRisk mission;
  /// Number of periods in which any limit is exceeded: by the period's plan (exceeds_limits), or by
  /// the drive up to the period's end.
  int exceeded_periods = 0;

  [[nodiscard]] bool any_limit() const {
    return stage.is_limited() || plan.is_limited() || mission.is_limited();
  }
};

/// Evaluates the certificates in the trace, which are never above those that the planner kept
/// within its limits. If a drive makes no plans, a period's plan is its next step.
[[nodiscard]] RiskUse risk_use(const Trace& trace);

/// Whether a period's plan exceeds a limit, according to its status (`risk_exceeded`, if the
/// planner enforces limits) or to its certificates. The mission limit enters only through the
/// status.
[[nodiscard]] bool exceeds_limits(const StepRecord& step, const Scenario::Risk& limits);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
