// Values given on the command line, put into a scenario's tree before it is read.
#pragma once

#include <string>

#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {

/// What errors call the place that overrides come from.
inline constexpr const char* kOverrideSource = "--set";

/// Sets one value of `root` to what `override` says, KEY=VALUE: KEY a dotted path in which a number
/// names an item of a list (one past the last appends), VALUE in YAML. Mappings that are not there
/// are made. What was set is marked, so that a problem with it is reported as one of "--set".
/// Throws InputError (file "--set") on a text that is no KEY=VALUE, on a VALUE that is not YAML,
/// and on a KEY that leads through a single value or past the end of a list.
void apply_override(YamlNode& root, const std::string& override);

}  // namespace qsmpc::harness
