// Bytes as text.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace qsmpc::harness {

/// RFC 4648, section 4, with padding.
[[nodiscard]] std::string base64(std::span<const std::uint8_t> bytes);

/// The base64 encoding of the bytes written as hexadecimal `digits`. Throws std::invalid_argument
/// on an odd number of digits or any other character.
[[nodiscard]] std::string base64_of_hex(std::string_view digits);

}  // namespace qsmpc::harness
