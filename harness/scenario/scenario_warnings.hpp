// Warnings about a valid scenario, before its first period.
#pragma once

#include <string>
#include <vector>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// One sentence without a full stop for each of: certificates that are not bounds, an angle that
/// looks like degrees, a risk limit that cannot be met, a start that is unsafe with a certified
/// probability above a limit, and a model error that was measured on another plant. Throws as
/// load_mujoco_model where a file states the vehicle of its model error.
[[nodiscard]] std::vector<std::string> scenario_warnings(const Scenario& scenario);

}  // namespace qsmpc::harness
