// The markers of a chart's points: one per colour, so that series can be told apart in greyscale
// and by colour-blind readers, and two more for series that share a colour. In the order of the
// page's palette: dot, square, triangle, diamond, cross and plus; then a triangle that points down
// and an hourglass.
#pragma once

#include <string>

namespace qsmpc::harness {

inline constexpr int kMarkerCount = 8;

/// The marker centred at (x, y), as path data; the data of several points may be concatenated.
[[nodiscard]] std::string mark_data(int marker, double x, double y);

/// The CSS classes of such a path in this colour.
[[nodiscard]] std::string mark_classes(int colour, int marker);

}  // namespace qsmpc::harness
