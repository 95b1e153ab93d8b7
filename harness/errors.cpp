#include "harness/errors.hpp"

#include <utility>

namespace qsmpc {
namespace {

std::string describe(const InputError::Where& where) {
  std::string text = printable(where.file, 400);
  if (where.line > 0) text += ":" + std::to_string(where.line);
  if (!where.key.empty()) text += (text.empty() ? "" : ": ") + printable(where.key);
  std::string detail;
  if (!where.found.empty()) detail = "found " + printable(where.found, 200);
  if (!where.expected.empty()) {
    detail += (detail.empty() ? "expected " : ", expected ") + printable(where.expected, 400);
  }
  if (!detail.empty()) text += (text.empty() ? "" : ": ") + detail;
  return text;
}

}  // namespace

InputError::InputError(Where where)
    : std::runtime_error(describe(where)), where_(std::move(where)) {}

std::string printable(const std::string& text, std::size_t limit) {
  std::string line;
  for (const char c : text) {
    if (line.size() >= limit) {
      // Not to cut a UTF-8 sequence in half: drop its continuation bytes and its lead.
      while (!line.empty() && (static_cast<unsigned char>(line.back()) & 0xC0U) == 0x80U) {
        line.pop_back();
      }
      if (!line.empty() && (static_cast<unsigned char>(line.back()) & 0x80U) != 0) line.pop_back();
      return line + "…";
    }
    const auto byte = static_cast<unsigned char>(c);
    line += byte < 0x20 || byte == 0x7F ? ' ' : c;
  }
  return line;
}

}  // namespace qsmpc
