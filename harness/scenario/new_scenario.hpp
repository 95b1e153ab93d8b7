// A scenario to begin with.
#pragma once

#include <string>

namespace qsmpc::harness {

/// A commented scenario of that name, as YAML: a car on wheels that finds its way around a block,
/// on the shipped vehicle of its system. What it leaves out is the default.
[[nodiscard]] std::string new_scenario_text(const std::string& name);

}  // namespace qsmpc::harness
