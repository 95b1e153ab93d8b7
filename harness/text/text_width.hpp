// How wide texts are: about, in a drawing; in columns, on a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace qsmpc::harness {

/// About how wide `text` is in a sans-serif font of `size`, rather more than less.
[[nodiscard]] double estimated_width(const std::string& text, double size);

/// `text` in lines of at most `columns` ≥ 1 characters, broken at spaces where there are some.
[[nodiscard]] std::vector<std::string> wrapped(const std::string& text, std::size_t columns);

/// `text` with spaces after it up to `columns` characters; each character takes one column.
[[nodiscard]] std::string padded(std::string text, std::size_t columns);

}  // namespace qsmpc::harness
