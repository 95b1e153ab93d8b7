// Text files that users write, read defensively, and the numbers in them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace qsmpc {

inline constexpr std::size_t kMaxTextFileBytes = std::size_t{1} << 20U;

/// The content of a regular file. Throws InputError when there is none at `path`, when it cannot be
/// read, or when it is larger than kMaxTextFileBytes.
[[nodiscard]] std::string read_text_file(const std::string& path);

/// The number that the whole of `text` is in decimal notation, e.g. "-1.5e3" or "+2"; nothing if it
/// is something else, words such as "inf" included, or too large or small for a double.
[[nodiscard]] std::optional<double> parse_decimal(std::string_view text);

}  // namespace qsmpc
