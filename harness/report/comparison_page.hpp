// The report of a comparison: one self-contained HTML page.
//
//   write_file(folder + "/report.html", comparison_page(read_comparison(folder)));
#pragma once

#include <string>

#include "harness/mismatch/comparison.hpp"

namespace qsmpc::harness {

/// The page as UTF-8 text: whether a certificate was exceeded and which plant is farthest from the
/// model, then the numbers with their figures. It loads nothing and runs no script; texts are
/// escaped. A comparison read back from its file gives the same page, byte for byte.
[[nodiscard]] std::string comparison_page(const Comparison& comparison);

}  // namespace qsmpc::harness
