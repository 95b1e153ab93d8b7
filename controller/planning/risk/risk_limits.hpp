// Limits of a plan's certified risk, and the certificates of a plan.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// Upper limits on certified probabilities; infinite for none.
struct RiskLimits {
  double first = std::numeric_limits<double>::infinity();  ///< of the next stage only
  double stage = std::numeric_limits<double>::infinity();  ///< of each stage
  double plan = std::numeric_limits<double>::infinity();   ///< of any stage

  [[nodiscard]] bool any() const;
};

/// What to do if no plan within the limits is found.
enum class RiskOtherwise {
  kLeastRisk,  ///< the plan with the least certificate
  kBrake,      ///< the plan that comes to rest soonest
  kPrevious,   ///< continue the last plan that was within its limits
  kModel,      ///< the plan within the limits for the model without its error
};

struct RiskOtherwiseEntry {
  std::string name;
  std::string summary;
  RiskOtherwise otherwise;
};

/// The table, the default first.
[[nodiscard]] const std::vector<RiskOtherwiseEntry>& risk_otherwise_entries();

/// Throws std::invalid_argument on an unknown name.
[[nodiscard]] RiskOtherwise risk_otherwise(std::string_view name);

/// The certificates of a plan as computed by the planner: by C3 and C4.
struct PlanRisk {
  std::vector<double> stages;  ///< of stages 1 … horizon; empty where there are no limits
  double plan = 1.0;           ///< of any stage: their sum or a lower bound in its place, at most 1
  bool counted = false;        ///< whether the limits were tried themselves, not only the aims
  /// Whether the certificates keep all limits: during the optimisation the aims, which leave some
  /// of each limit in reserve; of a finished plan the limits themselves.
  bool kept = true;
  /// log(certificate / aim) of the aim exceeded most, counting only what the plan can change;
  /// −infinity without limits. Deep inside the unsafe set, where certificates are 1, it measures
  /// the depth, so that plans remain comparable; an uninformative certificate, far from everything
  /// unsafe, is replaced by the surrogate's own probability.
  double severity = -std::numeric_limits<double>::infinity();
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
