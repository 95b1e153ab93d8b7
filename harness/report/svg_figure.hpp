// Charts as an SVG file of its own: with titles, legends and a style that any viewer draws.
//
//   write_file(folder + "/w2.svg", svg_figure({chart}));
#pragma once

#include <string>
#include <vector>

#include "harness/report/svg_chart.hpp"

namespace qsmpc {

/// The charts side by side, two in a row, as one SVG document in UTF-8 on a white ground. It refers
/// to nothing outside of itself. A chart without finite values says so.
[[nodiscard]] std::string svg_figure(const std::vector<Chart>& charts);

}  // namespace qsmpc
