// The parts of a scenario's JSON Schema that depend on its system.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "harness/scenario/keys/key_description.hpp"

namespace qsmpc::harness {

/// The names that `family` has in any system, each once.
[[nodiscard]] std::vector<std::string> names_of_family(NameFamily family);

/// For each system a condition: if `model.system` is it, then names and sizes in `keys` are its
/// own. The last condition tells systems of the user's own from those.
[[nodiscard]] nlohmann::ordered_json conditions_of_systems(const std::vector<KeyDescription>& keys);

}  // namespace qsmpc::harness
