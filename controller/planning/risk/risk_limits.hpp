// Limits of a plan's certified risk, and what a plan's certificates come to.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// Upper limits of certified probabilities; infinite where there is none.
struct RiskLimits {
  double first = std::numeric_limits<double>::infinity();  ///< of the next stage alone
  double stage = std::numeric_limits<double>::infinity();  ///< of each stage
  double plan = std::numeric_limits<double>::infinity();   ///< of any stage

  [[nodiscard]] bool any() const;
};

/// What is done where no plan within the limits is found.
enum class RiskOtherwise {
  kLeastRisk,  ///< the plan with the least certificate
  kBrake,      ///< the plan that comes to rest soonest
  kPrevious,   ///< the last plan within its limits goes on
  kModel,      ///< the plan within the limits for the model alone, without its error
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

/// The certificates of a plan, as the planner works them out: by C3 and C4.
struct PlanRisk {
  std::vector<double> stages;  ///< of stages 1 … horizon; empty where there are no limits
  double plan = 1.0;           ///< of any stage: their sum, or what was less, at most 1
  bool kept = true;            ///< whether all limits are, by what is certified
  /// log(certificate / limit) of the limit that is exceeded most, as far as certificates are made
  /// of what the plan can change: −infinity where none is. Deep inside the unsafe set, where
  /// certificates are 1, by how deep, so that the worse of two is told; and a certificate that says
  /// nothing, far from everything unsafe, counts for the surrogate's own probability.
  double severity = -std::numeric_limits<double>::infinity();
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
