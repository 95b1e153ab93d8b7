// The drive that edited files record, and the edits they have in common.
#pragma once

#include <string>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::testing {

/// Three periods, few points.
[[nodiscard]] const harness::Scenario& example_drive();

/// The content of an edit `scenario OLD => NEW`.
struct Replacement {
  std::string old;
  std::string with;
};

/// Parses such a line; without ` => `, the replacement is empty.
[[nodiscard]] Replacement replacement(const std::string& line);

}  // namespace qsmpc::testing
