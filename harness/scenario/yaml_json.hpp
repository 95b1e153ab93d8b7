// Conversion of YAML trees to JSON, for callers that do not read YAML.
#pragma once

#include <optional>

#include <nlohmann/json_fwd.hpp>

#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {

/// `node` as JSON: unquoted scalars become numbers, true, false and null where YAML reads them so;
/// all others become strings. Nothing where a number is not finite, which JSON cannot represent.
[[nodiscard]] std::optional<nlohmann::ordered_json> json_of(const YamlNode& node);

}  // namespace qsmpc::harness
