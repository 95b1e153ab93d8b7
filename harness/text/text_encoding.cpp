#include "harness/text/text_encoding.hpp"

#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

namespace qsmpc {
namespace {

constexpr std::uint32_t kFirstSurrogate = 0xD800;
constexpr std::uint32_t kLastSurrogate = 0xDFFF;
constexpr std::uint32_t kLastCodePoint = 0x10FFFF;
constexpr unsigned kDelete = 0x7F;

// Bytes of the well-formed UTF-8 sequence at the start of `text` (1 to 4), or 0 if there is none
// (RFC 3629: no overlong forms, no surrogates, nothing over U+10FFFF).
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return 0;
  std::uint32_t code = lead & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
    code = (code << 6U) | (byte(i) & 0x3FU);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= kFirstSurrogate && code <= kLastSurrogate;
  return code < kLeast[length] || code > kLastCodePoint || surrogate ? 0 : length;
}

bool is_allowed(std::string_view rest) {
  const auto byte = static_cast<unsigned char>(rest.front());
  if (byte == '\r') return rest.size() > 1 && rest[1] == '\n';
  return (byte >= 0x20 && byte != kDelete) || byte == '\n' || byte == '\t';
}

}  // namespace

std::optional<TextProblem> find_text_problem(std::string_view text) {
  int line = 1;
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view rest = text.substr(at);
    const std::size_t length = sequence_length(rest);
    const unsigned value = static_cast<unsigned char>(rest.front());
    if (length == 0) return TextProblem{line, fmt::format("the byte 0x{:02X}, not UTF-8", value)};
    if (length == 1 && !is_allowed(rest)) {
      return TextProblem{line, fmt::format("the control character 0x{:02X}", value)};
    }
    if (rest.front() == '\n') ++line;
    at += length;
  }
  return std::nullopt;
}

}  // namespace qsmpc
