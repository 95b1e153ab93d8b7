// The time that something took, by the clock of all timings of the program.
#pragma once

#include <chrono>

namespace qsmpc::harness {

/// Milliseconds since `start`.
[[nodiscard]] inline double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

}  // namespace qsmpc::harness
