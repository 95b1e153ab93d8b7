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

/// The schema of a mapping with `keys`, which are all that it takes. Where names and sizes depend
/// on the system, and `keys` has `model.system`, they are those of any system, and by conditions
/// those of the system that the file names.
[[nodiscard]] nlohmann::ordered_json json_schema(const SchemaHead& head,
                                                 const std::vector<KeyDescription>& keys);

/// That of a scenario file.
[[nodiscard]] nlohmann::ordered_json scenario_schema();

}  // namespace qsmpc::harness
