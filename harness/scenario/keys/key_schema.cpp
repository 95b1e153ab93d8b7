#include "harness/scenario/keys/key_schema.hpp"

#include <algorithm>
#include <cmath>
#include <regex>
#include <utility>

#include <nlohmann/json.hpp>

#include "harness/scenario/keys/key_words.hpp"
#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/keys/schema_of_system.hpp"
#include "harness/scenario/known_names.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

Json mapping_schema(const std::vector<KeyDescription>& keys);
Json key_schema(const KeyDescription& key);

void put_range(Json& schema, const NumberRange& range) {
  if (std::isfinite(range.least)) {
    schema[range.above_least ? "exclusiveMinimum" : "minimum"] = range.least;
  }
  if (std::isfinite(range.most)) schema["maximum"] = range.most;
}

/// The schema of each kind of value.
struct ValueSchema {
  Json operator()(const AnyValue& /*any*/) const { return Json::object(); }
  /// Any scalar is valid as text: YAML parses 2024 as a number.
  Json operator()(const TextValue& text) const {
    Json schema{{"type", {"string", "number", "boolean"}}, {"maxLength", text.longest}};
    if (!text.what.empty()) schema["minLength"] = 1;
    if (!text.pattern.empty()) schema["pattern"] = text.pattern;
    return schema;
  }
  Json operator()(const NameValue& name) const { return {{"enum", name.known}}; }
  /// The conditions list the names of each system; a user-defined system may have any.
  Json operator()(const SystemNameValue& /*name*/) const { return {{"type", "string"}}; }
  Json operator()(const NumberValue& number) const {
    Json schema{{"type", "number"}};
    put_range(schema, number.range);
    return schema;
  }
  Json operator()(const WholeValue& whole) const {
    return {{"type", "integer"}, {"minimum", whole.least}, {"maximum", whole.most}};
  }
  Json operator()(const FlagValue& /*flag*/) const { return {{"type", "boolean"}}; }
  Json operator()(const VectorValue& vector) const {
    Json schema{{"type", "array"}, {"items", (*this)(NumberValue{vector.range})}};
    if (vector.size == Dimension::kAny && vector.length > 0) {
      schema["minItems"] = vector.length;
      schema["maxItems"] = vector.length;
    }
    return schema;
  }
  Json operator()(const MatrixValue& /*matrix*/) const {
    return {{"type", "array"},
            {"minItems", 1},
            {"items", {{"type", {"number", "array"}}, {"items", {{"type", "number"}}}}}};
  }
  Json operator()(const IntervalValue& /*interval*/) const {
    return {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 2}, {"maxItems", 2}};
  }
  Json operator()(const MappingValue& mapping) const { return mapping_schema(mapping.keys); }
  Json operator()(const ListValue& list) const {
    Json schema{{"type", "array"}, {"items", key_schema(list.item.front())}};
    if (list.limits.least > 0) schema["minItems"] = list.limits.least;
    if (list.limits.most > 0) schema["maxItems"] = list.limits.most;
    if (list.limits.once) schema["uniqueItems"] = true;
    return schema;
  }
};

/// The union of `first` and `second`, whose types differ: the keywords of each apply only to its
/// own type.
Json either(Json first, const Json& second) {
  if (first.empty()) return second;
  Json types = Json::array();
  const auto add = [&types](const Json& type) {
    if (std::ranges::find(types, type) == types.end()) types.push_back(type);
  };
  for (const Json& type : {std::as_const(first)["type"], second["type"]}) {
    if (type.is_array()) {
      std::ranges::for_each(type, add);
    } else {
      add(type);
    }
  }
  first.update(second);
  first["type"] = std::move(types);
  return first;
}

/// The default, a single value, as JSON; a string unless the key holds a number or a flag.
Json default_json(const KeyDescription& key) {
  const KeyValue& value = key.values.front();
  const bool is_plain = std::holds_alternative<NumberValue>(value) ||
                        std::holds_alternative<WholeValue>(value) ||
                        std::holds_alternative<FlagValue>(value);
  return is_plain ? Json::parse(key.fallback) : Json(key.fallback);
}

/// Markdown without its links, escapes and emphasis, which editors do not show.
std::string plain_words(const std::string& markdown) {
  static const std::regex link(R"(\[([^\]]+)\]\([^)]+\))");
  std::string text = std::regex_replace(markdown, link, "$1");
  std::erase_if(text, [](char c) { return c == '\\' || c == '*'; });
  return text;
}

std::string hover_text(const KeyDescription& key) {
  std::string text = plain_words(filled_words(key));
  if (!key.unit.empty()) text += " [" + key.unit + "]";
  const std::string fallback = key.fallback_words.empty() ? key.fallback : key.fallback_words;
  if (!text.empty() && !fallback.empty()) text += "; default: " + plain_words(fallback);
  return text;
}

Json key_schema(const KeyDescription& key) {
  Json schema = Json::object();
  if (const std::string text = hover_text(key); !text.empty()) schema["description"] = text;
  Json values = Json::object();
  for (const KeyValue& value : key.values) {
    values = either(std::move(values), std::visit(ValueSchema{}, value));
  }
  schema.update(values);
  const bool is_list = !key.values.empty() && std::holds_alternative<ListValue>(key.values.front());
  if (!key.fallback.empty() && !is_list) schema["default"] = default_json(key);
  return schema;
}

void put_keys(Json& schema, const std::vector<KeyDescription>& keys) {
  for (const KeyDescription& key : keys) {
    if (key.name.empty()) {
      put_keys(schema, mapping_of(key)->keys);
    } else if (key.family == NameFamily::kFree) {
      schema["additionalProperties"] = key_schema(key);
    } else if (key.family != NameFamily::kNone) {
      for (const std::string& name : names_of_family(key.family)) {
        schema["properties"][name] = key_schema(key);
      }
      // User-defined systems have other names; the conditions restrict those of the known systems.
      schema["additionalProperties"] = key_schema(key);
    } else {
      schema["properties"][key.name] = key_schema(key);
      if (key.required) schema["required"].push_back(key.name);
    }
  }
}

Json mapping_schema(const std::vector<KeyDescription>& keys) {
  Json schema{{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}};
  put_keys(schema, keys);
  return schema;
}

}  // namespace

nlohmann::ordered_json json_schema(const SchemaHead& head,
                                   const std::vector<KeyDescription>& keys) {
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"title", head.title},
              {"description", head.description}};
  schema.update(mapping_schema(keys));
  return schema;
}

nlohmann::ordered_json scenario_schema() {
  std::vector<KeyDescription> keys;
  for (const ScenarioKey& key : scenario_keys()) keys.push_back(describe(key));
  Json schema = json_schema({.title = "qsmpc scenario",
                             .description = "One experiment: a system, the plant that represents "
                                            "it, noise, a map, a target and a controller."},
                            keys);
  schema["allOf"] = conditions_of_systems(keys);
  return schema;
}

}  // namespace qsmpc::harness
