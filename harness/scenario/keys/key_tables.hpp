// The tables of keys and systems in the documentation, in Markdown.
#pragma once

#include <string>
#include <vector>

#include "harness/scenario/keys/key_description.hpp"

namespace qsmpc::harness {

/// A table as it appears in a file of docs/ after the line `<!-- table: NAME -->`.
struct DocumentTable {
  std::string file;  ///< "docs/scenario.md"
  std::string name;
  std::string text;  ///< lines, each ending in a line feed
};

/// A row for each of `keys` that has words, and for each key of its mapping.
[[nodiscard]] std::string key_table(const std::vector<KeyDescription>& keys);

/// A row for each system: states, inputs, constants.
[[nodiscard]] std::string system_table();

/// The tables of the scenario's keys and of the systems, for the documentation.
[[nodiscard]] std::vector<DocumentTable> scenario_tables();

}  // namespace qsmpc::harness
