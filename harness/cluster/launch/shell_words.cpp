#include "harness/cluster/launch/shell_words.hpp"

#include <algorithm>
#include <string_view>

namespace qsmpc::harness {
namespace {

// On one line, without '!' and backslash, so that any login shell passes it on unchanged. Before
// setsid has created the group, a signal goes to the process only.
constexpr const char* kLeash =
    "exec 3<&0; "
    "setsid \"$@\" </dev/null 3<&- & w=$!; exec </dev/null >/dev/null 2>&1; "
    "end() { kill -s \"$1\" -- -$w || kill -s \"$1\" $w; }; "
    "{ while read -r x; do end TERM; done <&3; exec 3<&-; "
    "end TERM; sleep 5; end TERM; sleep 10; end KILL; } & r=$!; "
    "exec 3<&-; wait $w; s=$?; kill -s KILL $r; kill -s KILL -- -$w; exit $s";

bool is_plain(std::string_view word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./:,+@%";
  return !word.empty() && word.find_first_not_of(kPlain) == std::string_view::npos;
}

std::string quoted_word(const std::string& word) {
  if (is_plain(word)) return word;
  std::string text = "'";
  for (const char c : word) {
    if (c == '\'') {
      text += "'\\''";
    } else {
      text += c;
    }
  }
  return text + "'";
}

}  // namespace

std::string shell_command(const std::vector<std::string>& words) {
  std::string command;
  for (const std::string& word : words) {
    if (!command.empty()) command += ' ';
    command += quoted_word(word);
  }
  return command;
}

std::vector<std::string> leashed(const std::vector<std::string>& words) {
  std::vector<std::string> command{"sh", "-c", kLeash, "sh"};
  command.insert(command.end(), words.begin(), words.end());
  return command;
}

}  // namespace qsmpc::harness
