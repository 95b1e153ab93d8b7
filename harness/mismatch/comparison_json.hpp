// `comparison.json`: a comparison for other programs. docs/compare.md describes its keys.
#pragma once

#include <string>

#include "harness/mismatch/comparison.hpp"

namespace qsmpc::harness {

/// One object with stable keys, ending in a line feed. Numbers that are not finite are null. Equal
/// comparisons give equal bytes; two comparisons of the same scenario and options differ in `speed`
/// only.
[[nodiscard]] std::string comparison_json(const Comparison& comparison);

}  // namespace qsmpc::harness
