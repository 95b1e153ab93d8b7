// A comparison for a terminal.
#pragma once

#include <string>

#include "harness/mismatch/comparison.hpp"

namespace qsmpc::harness {

/// Lines of at most 96 characters for states and plants of names that are not longer than usual.
[[nodiscard]] std::string comparison_table(const Comparison& comparison);

}  // namespace qsmpc::harness
