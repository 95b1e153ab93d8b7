// The page of a contest: one self-contained HTML file.
//
//   write_file(folder + "/contest.html", contest_page(results));
#pragma once

#include <string>

#include "harness/contest/standings.hpp"

namespace qsmpc::harness {

/// The page as UTF-8 text: on the first screen the figure of risk against cost, a description of
/// each controller, and the table over all cells; then each cell, the candidates tried by the
/// search, and the rules of the contest. It links to the pages of the drives in its folder, loads
/// nothing and runs no script; texts are escaped.
[[nodiscard]] std::string contest_page(const ContestResults& results);

}  // namespace qsmpc::harness
