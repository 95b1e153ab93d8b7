// What is worth saying about a valid scenario before its first period.
#pragma once

#include <string>
#include <vector>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// One sentence without a full stop for each: a limit of the risk that nothing can keep, and a
/// start that is unsafe with a certified probability above a limit. Empty without limits.
[[nodiscard]] std::vector<std::string> scenario_warnings(const Scenario& scenario);

}  // namespace qsmpc::harness
