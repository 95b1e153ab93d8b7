// Long rows of numbers for a page's scripts: little-endian binary as base64, a third of their size
// as text.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace qsmpc::harness {

/// As 32-bit floating-point numbers, of which NaN stands for "none". What is too large becomes an
/// infinity.
[[nodiscard]] std::string packed_floats(const std::vector<double>& values);

/// As 16-bit and 8-bit numbers without a sign.
[[nodiscard]] std::string packed_words(const std::vector<std::uint16_t>& values);
[[nodiscard]] std::string packed_bytes(const std::vector<std::uint8_t>& values);

}  // namespace qsmpc::harness
