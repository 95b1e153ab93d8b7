// Fields of comma-separated values.
#pragma once

#include <string>

namespace qsmpc::harness {

/// `text` as one field: as it is, or quoted where it holds a comma, a quote or a line's end
/// (RFC 4180).
[[nodiscard]] std::string csv_field(const std::string& text);

}  // namespace qsmpc::harness
