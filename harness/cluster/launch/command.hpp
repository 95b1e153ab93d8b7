// Programs of the system that are asked something and end soon.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace qsmpc::harness {

struct CommandResult {
  int exit_code = 0;     ///< 128 + N where signal N ended it
  std::string output{};  ///< standard output
  std::string errors{};  ///< standard error
};

inline constexpr std::chrono::seconds kCommandPatience{120};

/// Runs `words`, the first looked for in PATH, with an empty standard input, and waits for its end.
/// Throws IoError where it cannot be started or takes longer than `patience`, and then kills it.
[[nodiscard]] CommandResult run_command(const std::vector<std::string>& words,
                                        std::chrono::milliseconds patience = kCommandPatience);

/// The same for one that succeeds: its standard output. Throws IoError, with the command and its
/// last words, where it does not.
std::string command_output(const std::vector<std::string>& words);

/// The last line of `text` that is not blank, safe for a terminal.
[[nodiscard]] std::string last_line(const std::string& text);

}  // namespace qsmpc::harness
