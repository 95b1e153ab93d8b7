// Where results go: standard output, for results and nothing else, and the folder of the files.
#pragma once

#include <string>
#include <vector>

namespace qsmpc::harness {

/// "out/NAME-SUFFIX", with what does not belong in a file name replaced in `name`.
[[nodiscard]] std::string default_folder(const std::string& name, const std::string& suffix);

/// Writes `text` to standard output. Throws IoError when it does not get there, e.g. on a full
/// disk.
void print_result(const std::string& text);

/// A line on standard error for each.
void print_warnings(const std::vector<std::string>& warnings);

}  // namespace qsmpc::harness
