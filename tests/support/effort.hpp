// How much a test draws or drives where more finds more.
//
// Sanitizers make everything about ten times slower, and find errors of memory in few samples as
// well as in many: statistics are for the builds without them.
#pragma once

#include <cstdlib>

#include "harness/threads/sanitizers.hpp"

namespace qsmpc::testing {

/// `all` where scripts/test is called with --slow, `few` where a sanitizer watches, else `usual`;
/// with both, `usual`.
template <class Number>
[[nodiscard]] Number by_effort(Number few, Number usual, Number all) {
  const bool slow = std::getenv("QSMPC_SLOW_TESTS") != nullptr;
#if QSMPC_ADDRESS_SANITIZER || QSMPC_THREAD_SANITIZER
  static_cast<void>(all);
  return slow ? usual : few;
#else
  static_cast<void>(few);
  return slow ? all : usual;
#endif
}

}  // namespace qsmpc::testing
