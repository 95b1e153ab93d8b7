// What stands for a number that is unknown, missing or not defined.
#pragma once

#include <limits>

namespace qsmpc {

inline constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

}  // namespace qsmpc
