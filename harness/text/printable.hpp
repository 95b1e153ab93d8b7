// Untrusted text made safe for one line of a terminal.
#pragma once

#include <cstddef>
#include <string>

namespace qsmpc::harness {

/// `text` on one line and safe for a terminal: control characters become spaces, a text longer
/// than `limit` bytes is cut and marked with "…".
[[nodiscard]] std::string printable(const std::string& text, std::size_t limit = 80);

}  // namespace qsmpc::harness
