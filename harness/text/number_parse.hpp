// Defensive parsing of numbers that users write: the whole text must be the number.
#pragma once

#include <charconv>
#include <concepts>
#include <optional>
#include <string_view>
#include <system_error>

namespace qsmpc::harness {

/// The integer that `text` as a whole represents, in decimal digits after an optional '-' for
/// signed types; nothing if it is anything else or does not fit into `Integer`.
template <std::integral Integer>
[[nodiscard]] std::optional<Integer> parse_integer(std::string_view text) {
  Integer value{};
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stopped != end) return std::nullopt;
  return value;
}

/// The number that `text` as a whole represents in decimal notation, e.g. "-1.5e3" or "+2"; nothing
/// if it is anything else, including words such as "inf", or too large or small for a double.
[[nodiscard]] std::optional<double> parse_decimal(std::string_view text);

}  // namespace qsmpc::harness
