// What is worth saying about a valid scenario before its first period.
#pragma once

#include <string>
#include <vector>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// One sentence without a full stop for each: certificates that are no bounds, an angle that looks
/// like degrees, a limit of the risk that nothing can keep, a start that is unsafe with a certified
/// probability above a limit, and a model error that was measured of another plant.
/// Throws as load_mujoco_model where a file says of which vehicle that was.
[[nodiscard]] std::vector<std::string> scenario_warnings(const Scenario& scenario);

}  // namespace qsmpc::harness
