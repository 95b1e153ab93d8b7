// Entries of the tables of things that are chosen by name.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace qsmpc::controller {

/// The entry of `table` that is called `name`. Throws std::invalid_argument if there is none; the
/// message has `what` it should be, e.g. "solver", and the names that are known.
template <class Entry>
[[nodiscard]] const Entry& named_entry(const std::vector<Entry>& table, std::string_view name,
                                       const char* what) {
  std::string known;
  for (const Entry& entry : table) {
    if (entry.name == name) return entry;
    known += (known.empty() ? "" : ", ") + entry.name;
  }
  throw std::invalid_argument("no " + std::string(what) + " '" + std::string(name) +
                              "'; known are: " + known);
}

}  // namespace qsmpc::controller
