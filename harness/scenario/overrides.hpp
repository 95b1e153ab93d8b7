// Command-line overrides, applied to a scenario's tree before it is read.
#pragma once

#include <string>

#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {

/// The "file" that errors name for overrides.
inline constexpr const char* kOverrideSource = "--set";

/// Sets one value of `root` as `override` says, KEY=VALUE: KEY is a dotted path in which a number
/// is the index of a list item (one past the last appends), VALUE is YAML. Missing mappings are
/// created. The new value is marked, so that a problem with it is reported in "--set". Throws
/// InputError (file "--set") on a text without the form KEY=VALUE, on a VALUE that is not YAML, and
/// on a KEY that leads through a scalar or past the end of a list.
void apply_override(YamlNode& root, const std::string& override);

}  // namespace qsmpc::harness
