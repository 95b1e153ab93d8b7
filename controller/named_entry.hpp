// Look-up of entries by name in the tables of selectable components.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace qsmpc::controller {

/// The entry of `table` named `name`. Throws std::invalid_argument if there is none; the message
/// says `what` was looked up, e.g. "solver", and lists the known names.
template <class Entry>
[[nodiscard]] const Entry& named_entry(const std::vector<Entry>& table, std::string_view name,
                                       const char* what) {
  std::string known;
  for (const Entry& entry : table) {
    if (entry.name == name) return entry;
    known += (known.empty() ? "" : ", ") + entry.name;
  }
  throw std::invalid_argument("no " + std::string(what) + " '" + std::string(name) +
                              "'; known: " + known);
}

}  // namespace qsmpc::controller
