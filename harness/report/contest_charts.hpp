// Risk against cost of a contest: what its page and contest.svg show.
#pragma once

#include <vector>

#include "harness/contest/standings.hpp"
#include "harness/figures/svg_chart.hpp"

namespace qsmpc::harness {

/// The file of the figure in a contest's folder.
inline constexpr const char* kContestFigure = "contest.svg";
inline constexpr const char* kContestPaperFigure = "contest.pdf";

/// One dot a controller: the share of its drives that were unsafe, and their cost relative to the
/// reference's on the same seeds, both with 99 % intervals, over all cells.
[[nodiscard]] Chart overall_chart(const ContestResults& results);

/// The same of each cell, with the mean cost of the drives that reached the target; without the
/// cells in which no controller has such a drive.
[[nodiscard]] std::vector<Chart> cell_charts(const ContestResults& results);

/// The charts of the figure: the one over all cells where there are several, then those of cells;
/// none without a dot.
[[nodiscard]] std::vector<Chart> contest_charts(const ContestResults& results);

}  // namespace qsmpc::harness
