// Standard output: results, and nothing else.
#pragma once

#include <string>

namespace qsmpc {

/// Writes `text` to standard output. Throws IoError when it does not get there, e.g. on a full
/// disk.
void print_result(const std::string& text);

}  // namespace qsmpc
