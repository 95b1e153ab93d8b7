// --fail-on: the outcomes that a command reports by its exit code.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace qsmpc::harness {

/// A drive whose true state entered the unsafe set, whatever happened afterwards.
inline constexpr const char* kFailOnUnsafe = "unsafe";
/// A drive with a period in which the plan, or the drive so far, exceeds a risk limit.
inline constexpr const char* kFailOnRiskExceeded = "risk_exceeded";
/// A certificate that a campaign refutes.
inline constexpr const char* kFailOnExceeded = "exceeded";

/// Adds --fail-on, which takes any of `words`, separated by commas; `fail_on` holds the default.
/// The former word left_safe_set becomes "unsafe".
void add_fail_on_option(CLI::App& command, std::vector<std::string>& fail_on,
                        const std::vector<std::string>& words);

}  // namespace qsmpc::harness
