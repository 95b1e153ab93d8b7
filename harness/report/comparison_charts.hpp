// A comparison of plants as figures.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/figures/svg_chart.hpp"
#include "harness/mismatch/comparison.hpp"

namespace qsmpc::harness {

/// A figure: charts shown together, and the name of its file.
struct ComparisonFigure {
  std::string file;  ///< e.g. "w2.svg"
  std::vector<Chart> charts;
};

/// Indices into the result of comparison_figures.
inline constexpr std::size_t kResidualFigure = 0;
inline constexpr std::size_t kDivergenceFigure = 1;
inline constexpr std::size_t kW2Figure = 2;
inline constexpr std::size_t kCertificateFigure = 3;

/// residuals.svg (root mean square by state), divergence.svg (by stage, one chart per state),
/// w2.svg (with the floor, by stage) and certificates.svg (against observed rates, one chart per
/// plant).
[[nodiscard]] std::vector<ComparisonFigure> comparison_figures(const Comparison& comparison);

}  // namespace qsmpc::harness
