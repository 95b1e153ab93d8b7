// Checks for keys that have no effect under the scenario's other settings.
#pragma once

#include <string>

#include <fmt/format.h>

#include "harness/scenario/yaml_section.hpp"

namespace qsmpc::harness {

/// Notes a value that would have no effect, unless it is the usual one, which every resolved
/// scenario contains. `condition`: what would give it an effect, e.g. "controller.kind: shield".
template <class Value>
void check_has_effect(Section& section, const char* key, const Value& value, const Value& usual,
                      bool has_effect, const std::string& condition) {
  if (has_effect || value == usual) return;
  section.note(key, fmt::format("{}, or {}", usual, condition));
}

}  // namespace qsmpc::harness
