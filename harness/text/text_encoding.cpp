#include "harness/text/text_encoding.hpp"

#include <cstddef>

#include <fmt/format.h>

#include "harness/text/utf8.hpp"

namespace qsmpc::harness {
namespace {

bool is_allowed(std::string_view rest) {
  const char byte = rest.front();
  if (byte == '\r') return rest.size() > 1 && rest[1] == '\n';
  return !is_control_character(byte) || byte == '\n' || byte == '\t';
}

}  // namespace

std::optional<TextProblem> find_text_problem(std::string_view text) {
  int line = 1;
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view rest = text.substr(at);
    const std::size_t length = utf8_length(rest);
    const unsigned value = static_cast<unsigned char>(rest.front());
    if (length == 0)
      return TextProblem{line, fmt::format("the byte 0x{:02X}, which is not valid UTF-8", value)};
    if (length == 1 && !is_allowed(rest)) {
      return TextProblem{line, fmt::format("the control character 0x{:02X}", value)};
    }
    if (rest.front() == '\n') ++line;
    at += length;
  }
  return std::nullopt;
}

}  // namespace qsmpc::harness
