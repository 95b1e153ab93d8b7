// Reading and writing how a system appears in a MuJoCo model: the keys `state`, `input`, `hold`,
// `loops`, `rolling`, `rate_limit`, `input_delay` and `time_steps` of `plant`, or the same keys in
// a text within a MuJoCo file.
#pragma once

#include <optional>
#include <string>

#include "harness/scenario/plant_mapping.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// What the mapping's names refer to besides the MuJoCo model.
struct MappedSystem {
  const models::SystemDescription& description;
  const models::ParameterMap& parameters;  ///< all of them
};

/// The mapping in `plant`, or nothing where none of its keys are there. Problems are noted, also a
/// state without a quantity and an input that nothing uses.
[[nodiscard]] std::optional<PlantMapping> read_plant_mapping(Section& plant,
                                                             const MappedSystem& system);

/// The mapping that `text` is. Throws InputError with `file` on anything that is wrong.
[[nodiscard]] PlantMapping parse_plant_mapping(const std::string& text, const std::string& file,
                                               const MappedSystem& system);

/// The name of the custom text of a MuJoCo file that holds its own mapping.
inline constexpr const char* kMappingText = "qsmpc";

/// The mapping in `text`, that of the MuJoCo file `file`. Throws InputError where there is none,
/// and as parse_plant_mapping.
[[nodiscard]] PlantMapping own_plant_mapping(const std::optional<std::string>& text,
                                             const std::string& file, const MappedSystem& system);

/// `loop` as an item of `loops` in YAML: "{kind: …}".
[[nodiscard]] std::string plant_loop_text(const PlantLoop& loop);

/// `mapping` as what stands between the braces of a mapping in YAML: "state: {…}, input: {…}".
[[nodiscard]] std::string plant_mapping_text(const PlantMapping& mapping);

}  // namespace qsmpc::harness
