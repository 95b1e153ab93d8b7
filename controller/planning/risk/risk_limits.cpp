#include "controller/planning/risk/risk_limits.hpp"

#include "controller/named_entry.hpp"

namespace qsmpc::controller {

bool RiskLimits::any() const {
  // A limit of 1 or more is always kept.
  return first < 1.0 || stage < 1.0 || plan < 1.0;
}

const std::vector<RiskOtherwiseEntry>& risk_otherwise_entries() {
  static const std::vector<RiskOtherwiseEntry> table = {
      {"least_risk", "the plan with the least certificate", RiskOtherwise::kLeastRisk},
      {"brake", "the plan that comes to rest soonest", RiskOtherwise::kBrake},
      {"previous", "the last plan within its limits is continued", RiskOtherwise::kPrevious},
      {"model", "the plan within the limits for the model without its error",
       RiskOtherwise::kModel},
  };
  return table;
}

RiskOtherwise risk_otherwise(std::string_view name) {
  return named_entry(risk_otherwise_entries(), name, "fallback").otherwise;
}

}  // namespace qsmpc::controller
