// Runs short-lived system programs.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace qsmpc::harness {

struct CommandResult {
  int exit_code = 0;     ///< 128 + N if signal N ended it
  std::string output{};  ///< standard output
  std::string errors{};  ///< standard error
};

inline constexpr std::chrono::seconds kCommandPatience{120};

/// Runs `words`, the first of which is looked up in PATH, with empty standard input, and waits for
/// its end. Throws IoError if it cannot be started or takes longer than `patience`; it is then
/// killed.
[[nodiscard]] CommandResult run_command(const std::vector<std::string>& words,
                                        std::chrono::milliseconds patience = kCommandPatience);

/// The standard output of a command that must succeed. Throws IoError, with the command and its
/// last line of output, if it does not.
std::string command_output(const std::vector<std::string>& words);

/// The last line of `text` that is not blank, safe for a terminal.
[[nodiscard]] std::string last_line(const std::string& text);

}  // namespace qsmpc::harness
