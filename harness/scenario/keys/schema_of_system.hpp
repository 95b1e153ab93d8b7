// The parts of a scenario's JSON Schema that depend on its system.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "harness/scenario/keys/key_description.hpp"

namespace qsmpc::harness {

/// The names of `family` over all systems, without duplicates.
[[nodiscard]] std::vector<std::string> names_of_family(NameFamily family);

/// One condition per system: if `model.system` names it, then the names and sizes in `keys` must be
/// those of the system. The last condition distinguishes user-defined systems from these.
[[nodiscard]] nlohmann::ordered_json conditions_of_systems(const std::vector<KeyDescription>& keys);

}  // namespace qsmpc::harness
