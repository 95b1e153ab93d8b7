// Runs the built program as a user would and checks its output, exit status and files.
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
  /// Called repeatedly with the process id while the process runs, until it returns true.
  std::function<bool(pid_t)> meanwhile{};
  std::vector<std::string> unset{};  ///< environment variables to remove
  long file_size_limit = -1;         ///< bytes; writing more fails as on a full disk
  long address_space = -1;           ///< bytes of address space, as by ulimit -v
};

/// Starts qsmpc with `arguments` and waits for its end.
[[nodiscard]] ProcessResult run_qsmpc(const std::vector<std::string>& arguments,
                                      const ProcessOptions& options = {});

/// Names of a folder's entries; empty if there is no such folder.
[[nodiscard]] std::set<std::string> files_in(const std::string& folder);

/// The whole content of a file; empty if it does not exist.
[[nodiscard]] std::string read_text(const std::string& path);

}  // namespace qsmpc::testing
