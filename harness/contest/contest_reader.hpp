// From a contest file's tree of keys to what it asks for, before scenarios are looked up.
#pragma once

#include <string>

#include "harness/contest/contest.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {

/// Reads `tree`. Everything wrong with it is noted in `problems`, and left out of what is returned.
/// The name defaults to the stem of `file`. Candidates of a controller whose grid is larger than
/// the budget are those that a fixed random order, of its name and grid alone, has first.
[[nodiscard]] Contest read_contest(const YamlNode& tree, const std::string& file,
                                   Problems& problems);

}  // namespace qsmpc::harness
