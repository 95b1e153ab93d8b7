// Reading and writing how a system appears in a MuJoCo model: the keys `state`, `input`, `hold`,
// `loops`, `rolling`, `rate_limit`, `input_delay` and `time_steps` of `plant`, or the same keys in
// a custom text of a MuJoCo file.
#pragma once

#include <optional>
#include <string>

#include "harness/scenario/plant_mapping.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// The context of the mapping's names, apart from the MuJoCo model.
struct MappedSystem {
  const models::SystemDescription& description;
  const models::ParameterMap& parameters;  ///< all of them
};

/// The mapping in `plant`; nothing where none of its keys are present. Notes problems, including a
/// state without a quantity and an input that nothing uses.
[[nodiscard]] std::optional<PlantMapping> read_plant_mapping(Section& plant,
                                                             const MappedSystem& system);

/// Parses the mapping in `text`. Throws InputError with `file` on any problem.
[[nodiscard]] PlantMapping parse_plant_mapping(const std::string& text, const std::string& file,
                                               const MappedSystem& system);

/// The name of the custom text in which a MuJoCo file holds its own mapping.
inline constexpr const char* kMappingText = "qsmpc";

/// The mapping in `text`, the custom text of the MuJoCo file `file`. Throws InputError where there
/// is none, and as parse_plant_mapping.
[[nodiscard]] PlantMapping own_plant_mapping(const std::optional<std::string>& text,
                                             const std::string& file, const MappedSystem& system);

/// `loop` as an item of `loops` in YAML: "{kind: …}".
[[nodiscard]] std::string plant_loop_text(const PlantLoop& loop);

/// `mapping` as the content of a YAML mapping, without its braces: "state: {…}, input: {…}".
[[nodiscard]] std::string plant_mapping_text(const PlantMapping& mapping);

}  // namespace qsmpc::harness
