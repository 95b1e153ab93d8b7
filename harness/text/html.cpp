#include "harness/text/html.hpp"

#include <cstddef>

#include "harness/text/utf8.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kReplacement = "\xEF\xBF\xBD";  // U+FFFD

std::string escaped_byte(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    case '\t':
    case '\n':
      return {c};
    default:
      return is_control_character(c) ? kReplacement : std::string(1, c);
  }
}

bool is_unreserved(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_' || c == '.' || c == '~';
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size() + text.size() / 8);
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 1) {
      escaped += escaped_byte(text.front());
    } else if (length == 0) {
      escaped += kReplacement;
    } else {
      escaped += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return escaped;
}

std::string url_beside(std::string_view name) {
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string url = "./";
  for (const char c : name) {
    if (is_unreserved(c)) {
      url += c;
    } else {
      const auto byte = static_cast<unsigned char>(c);
      url += {'%', kHex[byte / 16U], kHex[byte % 16U]};
    }
  }
  return url;
}

}  // namespace qsmpc::harness
