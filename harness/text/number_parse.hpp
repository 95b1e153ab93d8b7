// Numbers that users write, read defensively: the whole text is the number, or there is none.
#pragma once

#include <charconv>
#include <concepts>
#include <optional>
#include <string_view>
#include <system_error>

namespace qsmpc::harness {

/// The integer that the whole of `text` is, in decimal digits after an optional '-' for signed
/// types; nothing if it is something else or does not fit into `Integer`.
template <std::integral Integer>
[[nodiscard]] std::optional<Integer> parse_integer(std::string_view text) {
  Integer value{};
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stopped != end) return std::nullopt;
  return value;
}

/// The number that the whole of `text` is in decimal notation, e.g. "-1.5e3" or "+2"; nothing if it
/// is something else, words such as "inf" included, or too large or small for a double.
[[nodiscard]] std::optional<double> parse_decimal(std::string_view text);

}  // namespace qsmpc::harness
