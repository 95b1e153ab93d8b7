// Reads a contest file's key tree, before scenarios are looked up.
#pragma once

#include <string>

#include "harness/contest/contest.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {

/// Reads `tree`. Invalid parts are added to `problems` and left out of the result. The name
/// defaults to the stem of `file`. If a controller's grid is larger than the budget, its candidates
/// are the first ones of a fixed random order that depends only on the controller's name and grid.
[[nodiscard]] Contest read_contest(const YamlNode& tree, const std::string& file,
                                   Problems& problems);

}  // namespace qsmpc::harness
