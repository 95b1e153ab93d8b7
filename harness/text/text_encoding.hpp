// Whether bytes are plain text: UTF-8 without stray control characters.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace qsmpc::harness {

struct TextProblem {
  int line = 0;  ///< from 1
  std::string found;
};

/// The first byte of `text` that is not well-formed UTF-8, or that is a control character other
/// than tab, line feed or a carriage return before a line feed; nothing if there is none.
[[nodiscard]] std::optional<TextProblem> find_text_problem(std::string_view text);

}  // namespace qsmpc::harness
