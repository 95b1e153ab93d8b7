// A YAML document as a plain tree with line numbers, read defensively: any text, from any source,
// gives a tree or an InputError in bounded time, memory and stack.
//
// Only what experiment files need is accepted: one document of mappings, lists and scalars. Anchors
// and aliases (which can make a short text explode), explicit tags and keys that are not plain text
// are refused.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "harness/files/text_file.hpp"

namespace qsmpc::harness {

inline constexpr std::size_t kMaxYamlBytes = kMaxTextFileBytes;
inline constexpr std::size_t kMaxYamlDepth = 16;

struct YamlNode {
  enum class Kind { kNull, kText, kList, kMap };

  Kind kind = Kind::kNull;
  std::string text{};             ///< of a scalar, without quotes
  bool quoted = false;            ///< whether the scalar was quoted, and hence is not a number
  int line = 0;                   ///< from 1; 0 if not from a file
  int key_line = 0;               ///< line of the key of this value; 0 if there is none
  bool from_override = false;     ///< whether it came from the command line
  std::vector<YamlNode> items{};  ///< of a list; for a mapping, the value of each of `keys`
  std::vector<std::string> keys{};

  /// The value of `key` in a mapping, or nullptr.
  [[nodiscard]] const YamlNode* find(std::string_view key) const;
  [[nodiscard]] YamlNode* find(std::string_view key);
};

/// The description of a node in errors: the scalar itself, "nothing", "a list of 3" or "a mapping".
[[nodiscard]] std::string describe(const YamlNode& node);

/// Reads one document. `file`: its name in errors. Throws InputError on a text that is over
/// kMaxYamlBytes, not UTF-8, not YAML, empty or nested deeper than kMaxYamlDepth, and on duplicate
/// keys and other unsupported features.
[[nodiscard]] YamlNode parse_yaml(const std::string& text, const std::string& file);

}  // namespace qsmpc::harness
