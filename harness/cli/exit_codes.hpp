// Exit codes of the process; documented in the README.
#pragma once

#include <exception>

namespace qsmpc::harness {

enum ExitCode : int {
  kDone = 0,
  kToldFailure = 1,  ///< it ran, and the outcome is one listed in --fail-on
  kBadInput = 2,     ///< bad usage or bad file
  kIoTrouble = 3,    ///< something could not be read or written, or there was no memory for it
  kInternalError = 4,
  kInterruptedExit = 130,
};

/// Prints the exception on one line on standard error and returns its exit code.
[[nodiscard]] int report_exception(const std::exception_ptr& exception);

}  // namespace qsmpc::harness
