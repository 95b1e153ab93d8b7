// The JSON Schema (draft 7) of a file, for editors.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "harness/scenario/keys/key_description.hpp"

namespace qsmpc::harness {

struct SchemaHead {
  std::string title;
  std::string description;
};

/// The schema of a mapping that takes exactly `keys`. Where names and sizes depend on the system
/// and `keys` contains `model.system`, the schema accepts those of any system and adds conditions
/// that restrict them to those of the system that the file names.
[[nodiscard]] nlohmann::ordered_json json_schema(const SchemaHead& head,
                                                 const std::vector<KeyDescription>& keys);

/// The schema of a scenario file.
[[nodiscard]] nlohmann::ordered_json scenario_schema();

}  // namespace qsmpc::harness
