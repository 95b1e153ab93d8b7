// A template for new scenarios.
#pragma once

#include <string>

namespace qsmpc::harness {

/// A commented scenario of that name, as YAML: a car that finds its way around a block, with the
/// shipped vehicle of its system. Keys that are left out have their defaults.
[[nodiscard]] std::string new_scenario_text(const std::string& name);

}  // namespace qsmpc::harness
