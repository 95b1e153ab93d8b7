// Sample sizes and run lengths of tests that find more errors the longer they run.
//
// Sanitizers slow everything down about tenfold and find memory errors in few samples as well as in
// many; statistics are left to the builds without them.
#pragma once

#include <cstdlib>

#include "harness/threads/sanitizers.hpp"

namespace qsmpc::testing {

/// `all` when scripts/test runs with --slow, `few` under a sanitizer, else `usual`; `usual` if both
/// apply.
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
