// Destinations of results: standard output, which carries results only, and the folder of the
// files.
#pragma once

#include <string>
#include <vector>

namespace qsmpc::harness {

/// "out/NAME-SUFFIX", with characters that do not belong in a file name replaced in `name`. If any
/// was replaced, or the scenario was changed by `overrides` (--set), "-" and eight hexadecimal
/// digits follow, which distinguish it from other names and overrides.
[[nodiscard]] std::string default_folder(const std::string& name, const std::string& suffix,
                                         const std::vector<std::string>& overrides = {});

/// Writes `text` to standard output. Throws IoError if that fails, e.g. on a full disk.
void print_result(const std::string& text);

/// Prints each warning as a line on standard error.
void print_warnings(const std::vector<std::string>& warnings);

}  // namespace qsmpc::harness
