// Fields of comma-separated values.
#pragma once

#include <string>

namespace qsmpc::harness {

/// `text` as one field: as it is, or quoted where it holds a comma, a quote or a line's end
/// (RFC 4180). Text that a spreadsheet would take for a formula, beginning with = + - @ or a tab,
/// gets an apostrophe before it and is quoted. Not for numbers.
[[nodiscard]] std::string csv_field(const std::string& text);

}  // namespace qsmpc::harness
