// Fields of comma-separated values.
#pragma once

#include <string>

namespace qsmpc::harness {

/// `text` as one field: unchanged, or quoted if it contains a comma, a quote or a line break (RFC
/// 4180). Text that a spreadsheet would take for a formula, beginning with = + - @, a tab or a
/// carriage return, is prefixed with an apostrophe and quoted. Not for numbers.
[[nodiscard]] std::string csv_field(const std::string& text);

}  // namespace qsmpc::harness
