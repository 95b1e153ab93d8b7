// A YAML document as a plain tree with line numbers, read defensively: a text from anywhere gives a
// tree or an InputError, in bounded time, memory and stack.
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
  std::string text{};             ///< of a scalar, without its quotes
  bool quoted = false;            ///< whether the scalar was quoted, and hence is no number
  int line = 0;                   ///< from 1; 0 where it did not come from a file
  int key_line = 0;               ///< of the key that it is the value of; 0 for others
  bool from_override = false;     ///< whether it was given on the command line
  std::vector<YamlNode> items{};  ///< of a list; or of a mapping, one for each of `keys`
  std::vector<std::string> keys{};

  /// The value of `key` in a mapping, or nullptr.
  [[nodiscard]] const YamlNode* find(std::string_view key) const;
  [[nodiscard]] YamlNode* find(std::string_view key);
};

/// What a message says was found: the scalar itself, "nothing", "a list of 3" or "a mapping".
[[nodiscard]] std::string describe(const YamlNode& node);

/// Reads one document. `file` is what errors call it.
/// Throws InputError on a text over kMaxYamlBytes, one that is not UTF-8, not YAML, empty, nested
/// deeper than kMaxYamlDepth, or that has a key twice or something else that is not accepted.
[[nodiscard]] YamlNode parse_yaml(const std::string& text, const std::string& file);

}  // namespace qsmpc::harness
