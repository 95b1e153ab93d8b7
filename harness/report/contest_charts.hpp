// Charts of risk against cost of a contest, for its page and contest.svg.
#pragma once

#include <vector>

#include "harness/contest/standings.hpp"
#include "harness/figures/svg_chart.hpp"

namespace qsmpc::harness {

/// The file of the figure in a contest's folder.
inline constexpr const char* kContestFigure = "contest.svg";
inline constexpr const char* kContestPaperFigure = "contest.pdf";

/// One dot per controller, over all cells: the share of its drives that were unsafe, and their cost
/// relative to the reference's on the same seeds, both with 99 % intervals.
[[nodiscard]] Chart overall_chart(const ContestResults& results);

/// The same for each cell, with the mean cost of the drives that reached the target; cells in which
/// no controller has such a drive are left out.
[[nodiscard]] std::vector<Chart> cell_charts(const ContestResults& results);

/// The charts of the figure: first the one over all cells if there are several, then those of the
/// cells; charts without a dot are left out.
[[nodiscard]] std::vector<Chart> contest_charts(const ContestResults& results);

}  // namespace qsmpc::harness
