// What edited files are of, and what their edits have in common.
#pragma once

#include <string>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::testing {

/// Three periods with a few points.
[[nodiscard]] const harness::Scenario& example_drive();

/// What an edit `scenario OLD => NEW` says.
struct Replacement {
  std::string old;
  std::string with;
};

/// Of such a line; without ` => `, nothing is put in the place of what it has.
[[nodiscard]] Replacement replacement(const std::string& line);

}  // namespace qsmpc::testing
