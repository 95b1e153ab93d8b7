// Writing the keys of a scenario.
#pragma once

#include <string>

#include "harness/scenario/keys/scenario_key.hpp"

namespace qsmpc::harness {

/// What the member of `key` is by default, as YAML; empty for a key without one, for no text, and
/// for a matrix, whose default depends on the system.
[[nodiscard]] std::string default_text(const ScenarioKey& key);

}  // namespace qsmpc::harness
