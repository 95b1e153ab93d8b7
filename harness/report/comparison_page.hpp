// The report of a comparison: one HTML page that needs nothing but itself.
//
//   write_file(folder + "/report.html", comparison_page(read_comparison(folder)));
#pragma once

#include <string>

#include "harness/mismatch/comparison.hpp"

namespace qsmpc::harness {

/// The page as UTF-8 text: whether a certificate was exceeded and which plant is farthest from the
/// model, then the numbers with their figures. It loads nothing and runs no script; texts are
/// escaped. Of a comparison that was read from its file it is the same, byte for byte.
[[nodiscard]] std::string comparison_page(const Comparison& comparison);

}  // namespace qsmpc::harness
