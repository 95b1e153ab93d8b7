// --fail-on: what a command is asked to tell by its exit code.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace qsmpc::harness {

/// A drive whose true state entered the unsafe set, whatever became of it after that.
inline constexpr const char* kFailOnUnsafe = "unsafe";
/// A drive with a period whose plan, or the drive so far, exceeds a limit of the risk.
inline constexpr const char* kFailOnRiskExceeded = "risk_exceeded";
/// A certificate that a campaign refutes.
inline constexpr const char* kFailOnExceeded = "exceeded";

/// Adds --fail-on, which takes `words`, separated by commas, and what `fail_on` holds where it is
/// not given. The former word left_safe_set becomes "unsafe".
void add_fail_on_option(CLI::App& command, std::vector<std::string>& fail_on,
                        const std::vector<std::string>& words);

}  // namespace qsmpc::harness
