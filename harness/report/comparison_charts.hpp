// A comparison of plants as figures.
#pragma once

#include <string>
#include <vector>

#include "harness/mismatch/comparison.hpp"
#include "harness/report/svg_chart.hpp"

namespace qsmpc {

/// A figure: charts that stand together, and the name of its file.
struct ComparisonFigure {
  std::string file;  ///< e.g. "w2.svg"
  std::vector<Chart> charts;
};

/// residuals.svg (root mean square by state), divergence.svg (by stage, one chart a state), w2.svg
/// (with the floor, by stage) and certificates.svg (against what was observed, one chart a plant).
[[nodiscard]] std::vector<ComparisonFigure> comparison_figures(const Comparison& comparison);

}  // namespace qsmpc
