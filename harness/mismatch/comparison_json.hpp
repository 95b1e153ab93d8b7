// `comparison.json`: what programs read of a comparison. docs/compare.md describes its keys.
#pragma once

#include <string>

#include "harness/mismatch/comparison.hpp"

namespace qsmpc::harness {

/// One object with stable keys, ending in a new line. Numbers that are not finite are null. Equal
/// comparisons give equal bytes; of two of the same scenario and options, only `speed` differs.
[[nodiscard]] std::string comparison_json(const Comparison& comparison);

}  // namespace qsmpc::harness
