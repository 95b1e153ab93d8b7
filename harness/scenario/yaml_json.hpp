// Trees of YAML as JSON, for those who do not read YAML.
#pragma once

#include <optional>

#include <nlohmann/json_fwd.hpp>

#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {

/// `node` as JSON: scalars that are not quoted become numbers, true, false and null where YAML
/// takes them for such, all others texts. Nothing where a number is not finite, which JSON cannot
/// say.
[[nodiscard]] std::optional<nlohmann::ordered_json> json_of(const YamlNode& node);

}  // namespace qsmpc::harness
