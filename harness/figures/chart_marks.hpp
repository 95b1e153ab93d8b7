// The markers of a chart's points: one per colour, so that series can be told apart in greyscale
// and by colour-blind readers. In the order of the page's palette: dot, square, triangle, diamond,
// cross and plus.
#pragma once

#include <string>

namespace qsmpc::harness {

/// The marker of `colour` centred at (x, y), as path data; the data of several points may be
/// concatenated.
[[nodiscard]] std::string mark_data(int colour, double x, double y);

/// The CSS classes of such a path.
[[nodiscard]] std::string mark_classes(int colour);

}  // namespace qsmpc::harness
