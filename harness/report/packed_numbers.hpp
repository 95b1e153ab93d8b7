// Long rows of numbers for a page's scripts: little-endian binary as base64, a third of the size of
// text.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace qsmpc::harness {

/// Packs 32-bit floating-point numbers, where NaN stands for "none". Values out of range become
/// infinite.
[[nodiscard]] std::string packed_floats(const std::vector<double>& values);

/// Pack unsigned 16-bit and 8-bit numbers.
[[nodiscard]] std::string packed_words(const std::vector<std::uint16_t>& values);
[[nodiscard]] std::string packed_bytes(const std::vector<std::uint8_t>& values);

}  // namespace qsmpc::harness
