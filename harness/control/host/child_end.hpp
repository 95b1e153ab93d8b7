// How a controller's process ended, as reported by its host to the program.
#pragma once

#include <cstdint>

namespace qsmpc::harness {

struct ChildEnd {
  enum How : std::int32_t { kExit, kSignal, kNoStart };

  How how = kExit;
  std::int32_t value = 0;  ///< exit code, signal, or errno
};

}  // namespace qsmpc::harness
