// From a scenario's tree of keys to a checked Scenario.
#pragma once

#include <string>

#include "harness/scenario/scenario.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {

/// How the files that a scenario names are looked up.
struct FileLookup {
  std::string folder;      ///< of the scenario; the current one when empty
  bool must_exist = true;  ///< otherwise a file that is not found keeps the name that was written
  /// Whether a program wrote the scenario: what it does not say is from before it could be said.
  bool is_recorded = false;
};

/// Reads `tree`, with defaults filled in. Everything wrong with it is noted in `problems`; the
/// scenario is valid only if nothing was.
[[nodiscard]] Scenario read_scenario(const YamlNode& tree, const FileLookup& lookup,
                                     Problems& problems);

}  // namespace qsmpc::harness
