#include "harness/text/printable.hpp"

#include "harness/text/utf8.hpp"

namespace qsmpc::harness {
namespace {

constexpr unsigned char kFirstNotAscii = 0x80;

/// Drops the last character if it has several bytes, since the cut may have split it.
void drop_long_character(std::string& line) {
  while (!line.empty() && !begins_utf8_character(line.back())) line.pop_back();
  if (!line.empty() && static_cast<unsigned char>(line.back()) >= kFirstNotAscii) line.pop_back();
}

}  // namespace

std::string printable(const std::string& text, std::size_t limit) {
  std::string line;
  for (const char c : text) {
    if (line.size() >= limit) {
      drop_long_character(line);
      return line + "…";
    }
    line += is_control_character(c) ? ' ' : c;
  }
  return line;
}

}  // namespace qsmpc::harness
