// The structure of UTF-8: where characters begin, and which bytes are invalid (RFC 3629).
#pragma once

#include <cstddef>
#include <string_view>

namespace qsmpc::harness {

/// Length in bytes, 1 to 4, of the well-formed UTF-8 character at the start of `text`; 0 if there
/// is none. Overlong forms, surrogates and values above U+10FFFF are not well-formed.
/// text: not empty.
[[nodiscard]] std::size_t utf8_length(std::string_view text);

/// Whether `byte` begins a character, rather than continuing one.
[[nodiscard]] constexpr bool begins_utf8_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
}

/// Number of characters in `text`, counted as bytes that begin one, without checking that `text` is
/// well-formed.
[[nodiscard]] std::size_t utf8_characters(std::string_view text);

/// Whether `byte` is an ASCII control character: below the space, or delete.
[[nodiscard]] constexpr bool is_control_character(char byte) {
  constexpr unsigned char kSpace = 0x20;
  constexpr unsigned char kDelete = 0x7F;
  const auto value = static_cast<unsigned char>(byte);
  return value < kSpace || value == kDelete;
}

}  // namespace qsmpc::harness
