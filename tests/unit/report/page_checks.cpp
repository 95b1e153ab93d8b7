#include "tests/unit/report/page_checks.hpp"

#include <cctype>
#include <set>
#include <vector>

namespace qsmpc::testing {
namespace {

/// Position of the '>' that ends the tag at `begin`, respecting quotes; npos if there is none.
std::size_t tag_end(const std::string& html, std::size_t begin) {
  bool quoted = false;
  for (std::size_t i = begin + 1; i < html.size(); ++i) {
    if (html[i] == '"') quoted = !quoted;
    if (!quoted && html[i] == '>') return i;
    if (html[i] == '<') return std::string::npos;
  }
  return std::string::npos;
}

std::string tag_name(const std::string& tag) {
  std::size_t end = 0;
  while (end < tag.size() && (std::isalnum(static_cast<unsigned char>(tag[end])) != 0)) ++end;
  return tag.substr(0, end);
}

}  // namespace

std::string tag_problem(const std::string& html) {
  const std::set<std::string> never_closed = {"meta"};
  std::vector<std::string> open;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at)) {
    const std::size_t end = tag_end(html, at);
    if (end == std::string::npos) return "unfinished tag: " + html.substr(at, 60);
    const std::string tag = html.substr(at + 1, end - at - 1);
    at = end;
    if (tag.starts_with('!') || tag.ends_with('/')) continue;
    if (!tag.starts_with('/')) {
      const std::string name = tag_name(tag);
      if (name.empty()) return "no tag: <" + tag + ">";
      if (!never_closed.contains(name)) open.push_back(name);
    } else if (open.empty() || open.back() != tag.substr(1)) {
      return "closed but not open: <" + tag + ">";
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : "not closed: <" + open.back() + ">";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

int occurrences(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

}  // namespace qsmpc::testing
