// Widths of texts: approximate ones in drawings, columns on terminals.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace qsmpc::harness {

/// Approximate width of `text` in a sans-serif font of `size`; errs on the wide side.
[[nodiscard]] double estimated_width(const std::string& text, double size);

/// `text` in lines of at most `columns` ≥ 1 characters, broken at spaces where possible.
[[nodiscard]] std::vector<std::string> wrapped(const std::string& text, std::size_t columns);

/// `text` padded with trailing spaces to `columns` characters; each character takes one column.
[[nodiscard]] std::string padded(std::string text, std::size_t columns);

}  // namespace qsmpc::harness
