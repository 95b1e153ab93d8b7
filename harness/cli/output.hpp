// Where results go: standard output, for results and nothing else, and the folder of the files.
#pragma once

#include <string>

#include "harness/scenario/scenario.hpp"

namespace qsmpc {

/// "out/NAME-SUFFIX", with what does not belong in a file name replaced in the scenario's name.
[[nodiscard]] std::string default_folder(const Scenario& scenario, const std::string& suffix);

/// Writes `text` to standard output. Throws IoError when it does not get there, e.g. on a full
/// disk.
void print_result(const std::string& text);

}  // namespace qsmpc
