// Writing the keys of a scenario.
#pragma once

#include <string>

#include "harness/scenario/keys/scenario_key.hpp"

namespace qsmpc::harness {

/// The default of the member of `key`, as YAML; empty for a key without a member, for an empty
/// text, and for a matrix, whose default depends on the system.
[[nodiscard]] std::string default_text(const ScenarioKey& key);

}  // namespace qsmpc::harness
