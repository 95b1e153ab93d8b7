// The page of a contest: one HTML file that needs nothing but itself.
//
//   write_file(folder + "/contest.html", contest_page(results));
#pragma once

#include <string>

#include "harness/contest/standings.hpp"

namespace qsmpc::harness {

/// The page as UTF-8 text: on the first screen the figure of risk against cost, words about each
/// controller, and the table over all cells; then each cell, what the search tried, and how the
/// contest was held. It links the pages of the drives in its folder, loads nothing and runs no
/// script; texts are escaped.
[[nodiscard]] std::string contest_page(const ContestResults& results);

}  // namespace qsmpc::harness
