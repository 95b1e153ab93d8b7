#include "harness/scenario/yaml_json.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <nlohmann/json.hpp>

#include "harness/scenario/yaml_section.hpp"
#include "harness/text/number_parse.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

std::optional<Json> scalar_json(const YamlNode& node) {
  if (node.quoted) return Json(node.text);
  for (const char* word : {"true", "True", "TRUE"}) {
    if (node.text == word) return Json(true);
  }
  for (const char* word : {"false", "False", "FALSE"}) {
    if (node.text == word) return Json(false);
  }
  if (const auto whole = parse_integer<std::int64_t>(node.text)) return Json(*whole);
  const std::optional<double> number = parse_number(node);
  if (!number) return Json(node.text);
  if (!std::isfinite(*number)) return std::nullopt;
  return Json(*number);
}

}  // namespace

std::optional<nlohmann::ordered_json> json_of(const YamlNode& node) {
  if (node.kind == YamlNode::Kind::kNull) return Json(nullptr);
  if (node.kind == YamlNode::Kind::kText) return scalar_json(node);
  const bool is_map = node.kind == YamlNode::Kind::kMap;
  Json json = is_map ? Json::object() : Json::array();
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    std::optional<Json> item = json_of(node.items[i]);
    if (!item) return std::nullopt;
    if (is_map) {
      json[node.keys[i]] = std::move(*item);
    } else {
      json.push_back(std::move(*item));
    }
  }
  return json;
}

}  // namespace qsmpc::harness
