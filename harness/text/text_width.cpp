#include "harness/text/text_width.hpp"

#include <cstddef>

#include "harness/text/utf8.hpp"

namespace qsmpc::harness {

double estimated_width(const std::string& text, double size) {
  constexpr double kWidthOfSize = 0.56;        // average letter width, with some margin
  constexpr unsigned char kThreeBytes = 0xE0;  // scripts whose characters may be square, and
                                               // symbols
  double width = 0.0;
  for (const char byte : text) {
    if (!begins_utf8_character(byte)) continue;
    width += static_cast<unsigned char>(byte) >= kThreeBytes ? 1.0 : kWidthOfSize;
  }
  return width * size;
}

std::vector<std::string> wrapped(const std::string& text, std::size_t columns) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = begin;
    for (std::size_t count = 0; end < text.size(); ++end) {
      if (begins_utf8_character(text[end]) && ++count > columns) break;
    }
    if (end < text.size()) {
      const std::size_t space = text.rfind(' ', end);
      if (space != std::string::npos && space > begin) end = space;
    }
    lines.push_back(text.substr(begin, end - begin));
    begin = end < text.size() && text[end] == ' ' ? end + 1 : end;
  }
  return lines;
}

std::string padded(std::string text, std::size_t columns) {
  const std::size_t taken = utf8_characters(text);
  if (taken < columns) text.append(columns - taken, ' ');
  return text;
}

}  // namespace qsmpc::harness
