// Runs the built program as a user does and looks at what it prints, returns and leaves behind.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include <sys/types.h>

#include "tests/support/temporary_folder.hpp"

namespace qsmpc::testing {

struct ProcessResult {
  int exit_code = -1;  ///< 128 + signal where a signal ended it
  std::string output;  ///< standard output
  std::string errors;  ///< standard error
};

struct ProcessOptions {
  std::string folder{};  ///< current folder of the process
  /// Called with the process's number while it runs, again and again until it returns true.
  std::function<bool(pid_t)> meanwhile{};
  std::vector<std::string> unset{};  ///< environment variables to remove
  long file_size_limit = -1;         ///< bytes; writing more fails as on a full disk
  long address_space = -1;           ///< bytes that the process may map, as by ulimit -v
};

/// Starts qsmpc with `arguments` and waits for its end.
[[nodiscard]] ProcessResult run_qsmpc(const std::vector<std::string>& arguments,
                                      const ProcessOptions& options = {});

/// Names of what is in a folder; none where there is no such folder.
[[nodiscard]] std::set<std::string> files_in(const std::string& folder);

/// The whole content of a file; empty where there is none.
[[nodiscard]] std::string read_text(const std::string& path);

}  // namespace qsmpc::testing
