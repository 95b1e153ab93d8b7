// Numbers that every room needs by name.
#pragma once

#include <limits>

namespace qsmpc {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

}  // namespace qsmpc
