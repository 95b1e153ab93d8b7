// Converts a scenario's tree of keys into a checked Scenario.
#pragma once

#include <string>

#include "harness/scenario/scenario.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {

/// The lookup rules for files that a scenario names.
struct FileLookup {
  std::string folder;      ///< of the scenario; the current one when empty
  bool must_exist = true;  ///< otherwise a missing file keeps the name as written
  /// Whether a program wrote the scenario: absent keys then mean that it predates them.
  bool is_recorded = false;
};

/// Reads `tree`, filling in defaults. All problems are noted in `problems`; the scenario is valid
/// only if there are none.
[[nodiscard]] Scenario read_scenario(const YamlNode& tree, const FileLookup& lookup,
                                     Problems& problems);

}  // namespace qsmpc::harness
