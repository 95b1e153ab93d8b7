// Named constants that all folders use.
#pragma once

#include <limits>

#pragma GCC visibility push(default)

namespace qsmpc {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

}  // namespace qsmpc

#pragma GCC visibility pop
