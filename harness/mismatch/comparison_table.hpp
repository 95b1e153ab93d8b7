// A comparison as text for a terminal.
#pragma once

#include <string>

#include "harness/mismatch/comparison.hpp"

namespace qsmpc::harness {

/// Lines of at most 96 characters, if the names of states and plants have a usual length.
[[nodiscard]] std::string comparison_table(const Comparison& comparison);

}  // namespace qsmpc::harness
