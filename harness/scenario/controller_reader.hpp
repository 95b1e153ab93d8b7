// The section `controller` of a scenario.
#pragma once

#include "harness/scenario/scenario.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Reads `section`, with defaults filled in; `system` is the one that is controlled. Everything
/// wrong with it is noted.
[[nodiscard]] Scenario::Controller read_controller(Section& section,
                                                   const models::SystemDescription& system);

}  // namespace qsmpc::harness
