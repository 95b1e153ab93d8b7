#include "harness/scenario/overrides.hpp"

#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/errors.hpp"
#include "harness/text/number_parse.hpp"

namespace qsmpc::harness {
namespace {

void mark_overridden(YamlNode& node) {
  node.from_override = true;
  for (YamlNode& item : node.items) mark_overridden(item);
}

std::vector<std::string> split_key(const std::string& key) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = key.find('.', begin);
    parts.push_back(key.substr(begin, end == std::string::npos ? end : end - begin));
    if (parts.back().empty()) {
      throw InputError({.file = kOverrideSource,
                        .key = key,
                        .found = "an empty part of a key",
                        .expected = "names joined by dots"});
    }
  }
  if (parts.size() >= kMaxYamlDepth) {
    throw InputError({.file = kOverrideSource, .key = key, .found = "a key with too many parts"});
  }
  return parts;
}

YamlNode& child_in_map(YamlNode& map, const std::string& key) {
  if (YamlNode* child = map.find(key)) return *child;
  map.keys.push_back(key);
  map.items.emplace_back();
  map.items.back().from_override = true;
  return map.items.back();
}

YamlNode& child_in_list(YamlNode& list, const std::string& part, const std::string& key) {
  const auto index = parse_integer<std::size_t>(part);
  if (!index || *index > list.items.size()) {
    throw InputError({.file = kOverrideSource,
                      .key = key,
                      .found = part,
                      .expected = "an index from 0 to " + std::to_string(list.items.size())});
  }
  if (*index == list.items.size()) list.items.emplace_back();
  // A list is checked as a whole, so a problem with it may be due to this item.
  list.from_override = true;
  return list.items[*index];
}

YamlNode& child(YamlNode& parent, const std::string& part, const std::string& key) {
  if (parent.kind == YamlNode::Kind::kNull) parent.kind = YamlNode::Kind::kMap;
  if (parent.kind == YamlNode::Kind::kMap) return child_in_map(parent, part);
  if (parent.kind == YamlNode::Kind::kList) return child_in_list(parent, part, key);
  throw InputError(
      {.file = kOverrideSource,
       .key = key,
       .found = "the value " + describe(parent) + " where \"" + part + "\" is looked up",
       .expected = "a mapping or a list there"});
}

YamlNode parse_value(const std::string& key, const std::string& text) {
  // The parser rejects blank text; here it is the empty value.
  if (text.find_first_not_of(' ') == std::string::npos) return {};
  try {
    return parse_yaml(text, kOverrideSource);
  } catch (const InputError& error) {
    InputError::Where where = error.where();
    where.line = 0;
    where.key = where.key.empty() ? key : key + "." + where.key;
    throw InputError(where);
  }
}

}  // namespace

void apply_override(YamlNode& root, const std::string& override) {
  const std::size_t equals = override.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError({.file = kOverrideSource,
                      .found = "\"" + override + "\"",
                      .expected = "KEY=VALUE, e.g. controller.horizon=12"});
  }
  const std::string key = override.substr(0, equals);
  YamlNode value = parse_value(key, override.substr(equals + 1));
  YamlNode* node = &root;
  for (const std::string& part : split_key(key)) node = &child(*node, part, key);
  // The line is that of the replaced value; no error is reported at it.
  *node = std::move(value);
  mark_overridden(*node);
}

}  // namespace qsmpc::harness
