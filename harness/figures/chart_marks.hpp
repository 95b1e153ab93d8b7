// The signs that points of a chart are drawn as: one a colour, so that series can be told apart in
// grey and by those who do not see colours. That of the first colour of the page's palette is a
// dot, the others are square, triangle, diamond, cross and plus.
#pragma once

#include <string>

namespace qsmpc::harness {

/// The sign of `colour` about (x, y), as data of a path; those of several points may be joined.
[[nodiscard]] std::string mark_data(int colour, double x, double y);

/// The classes of such a path.
[[nodiscard]] std::string mark_classes(int colour);

}  // namespace qsmpc::harness
