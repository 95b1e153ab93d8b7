#include "harness/scenario/keys/schema_of_system.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/scenario/known_names.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kAnyPeriod = 0.1;  // s; the names do not depend on it

struct SystemNames {
  const models::SystemEntry& system;
  std::vector<std::string> states{};
  std::vector<std::string> angles{};
  std::vector<std::string> inputs{};
  std::vector<std::string> parameters{};

  [[nodiscard]] const std::vector<std::string>& of(NameFamily family) const {
    switch (family) {
      case NameFamily::kStates:
        return states;
      case NameFamily::kAngles:
        return angles;
      case NameFamily::kInputs:
        return inputs;
      case NameFamily::kParameters:
        return parameters;
      case NameFamily::kNone:
      case NameFamily::kFree:
        break;
    }
    static const std::vector<std::string> none;
    return none;
  }
};

const std::vector<SystemNames>& names_of_systems() {
  static const std::vector<SystemNames> all = [] {
    std::vector<SystemNames> names;
    for (const models::SystemEntry& entry : models::systems()) {
      const auto dynamics = models::make_dynamics(entry.name, {}, kAnyPeriod);
      const models::SystemDescription& description = dynamics->description();
      SystemNames system{.system = entry,
                         .states = coordinate_names(description.states),
                         .inputs = coordinate_names(description.inputs)};
      for (const models::Coordinate& state : description.states) {
        if (state.is_angle) system.angles.push_back(state.name);
      }
      for (const auto& [name, value] : entry.defaults) system.parameters.push_back(name);
      names.push_back(std::move(system));
    }
    return names;
  }();
  return all;
}

Json part_of_mapping(const std::vector<KeyDescription>& keys, const SystemNames& names);
Json part_of_key(const KeyDescription& key, const SystemNames& names);

/// The constraints that the system adds to the schema of a value; empty without any.
struct SystemPart {
  const SystemNames& names;

  Json operator()(const SystemNameValue& name) const {
    const std::vector<std::string>& known = names.of(name.family);
    if (known.empty()) return {{"not", Json::object()}};  // an enum may not be empty
    return {{"enum", known}};
  }
  Json operator()(const VectorValue& vector) const { return of_size(vector.size); }
  Json operator()(const MatrixValue& matrix) const {
    // A single row may be written as a list of its numbers.
    const bool is_row = matrix.rows != matrix.cols && names.inputs.size() == 1;
    Json part = is_row ? Json::object() : of_size(matrix.rows);
    part["items"] = of_size(matrix.cols);
    return part;
  }
  Json operator()(const MappingValue& mapping) const {
    return part_of_mapping(mapping.keys, names);
  }
  Json operator()(const ListValue& list) const {
    Json item = part_of_key(list.item.front(), names);
    return item.empty() ? Json::object() : Json{{"items", std::move(item)}};
  }
  template <class Value>
  Json operator()(const Value& /*value*/) const {
    return Json::object();
  }

 private:
  [[nodiscard]] Json of_size(Dimension size) const {
    if (size == Dimension::kAny) return Json::object();
    const std::size_t count =
        size == Dimension::kStates ? names.states.size() : names.inputs.size();
    return {{"minItems", count}, {"maxItems", count}};
  }
};

Json part_of_key(const KeyDescription& key, const SystemNames& names) {
  Json part = Json::object();
  for (const KeyValue& value : key.values) part.update(std::visit(SystemPart{names}, value));
  return part;
}

/// What editors show for a constant.
Json parameter_part(const models::SystemEntry& entry, const std::string& name) {
  const double value = entry.defaults.at(name);
  return {{"description", fmt::format("constant of the system {} [{}]; default: {}", entry.name,
                                      entry.units.at(name), value)},
          {"default", value}};
}

void put_parts(Json& part, std::vector<std::string>& known, bool& has_family,
               const std::vector<KeyDescription>& keys, const SystemNames& names) {
  for (const KeyDescription& key : keys) {
    if (key.name.empty()) {
      put_parts(part, known, has_family, mapping_of(key)->keys, names);
      continue;
    }
    const bool is_family = key.family != NameFamily::kNone && key.family != NameFamily::kFree;
    has_family = has_family || is_family;
    for (const std::string& name : is_family ? names.of(key.family) : std::vector{key.name}) {
      known.push_back(name);
      const Json inner = key.family == NameFamily::kParameters ? parameter_part(names.system, name)
                                                               : part_of_key(key, names);
      if (!inner.empty()) part["properties"][name] = inner;
    }
  }
}

Json part_of_mapping(const std::vector<KeyDescription>& keys, const SystemNames& names) {
  Json part = Json::object();
  std::vector<std::string> known;
  bool has_family = false;
  put_parts(part, known, has_family, keys, names);
  if (!has_family) return part;
  if (known.empty()) {
    part["maxProperties"] = 0;  // e.g. the constants of a system without constants
  } else {
    part["propertyNames"] = {{"enum", known}};
  }
  return part;
}

/// A user-defined model.
Json is_own() { return {{"anyOf", {{{"required", {"library"}}}, {{"required", {"equations"}}}}}}; }

Json is_system(const std::string& name) {
  const Json system{
      {"properties", {{"system", {{"const", name}}}}}, {"required", {"system"}}, {"not", is_own()}};
  return {{"properties", {{"model", system}}}, {"required", {"model"}}};
}

Json of_model(Json part) { return {{"properties", {{"model", std::move(part)}}}}; }

/// A model either has the keys of a user-defined one, or a known name.
Json condition_of_own(const std::vector<KeyDescription>& keys) {
  std::vector<std::string> own;
  for (const KeyDescription& key : keys) {
    if (key.name != "model") continue;
    for (const KeyDescription& inner : mapping_of(key)->keys) {
      if (inner.family == NameFamily::kNone) own.push_back(inner.name);
    }
  }
  Json is_of_own = of_model(is_own());
  is_of_own["required"] = {"model"};
  return {{"if", std::move(is_of_own)},
          {"then", of_model({{"propertyNames", {{"enum", own}}}})},
          {"else", of_model({{"properties", {{"system", {{"enum", system_names()}}}}},
                             {"required", {"system"}}})}};
}

}  // namespace

std::vector<std::string> names_of_family(NameFamily family) {
  std::vector<std::string> all;
  for (const SystemNames& names : names_of_systems()) {
    for (const std::string& name : names.of(family)) {
      if (std::ranges::find(all, name) == all.end()) all.push_back(name);
    }
  }
  return all;
}

nlohmann::ordered_json conditions_of_systems(const std::vector<KeyDescription>& keys) {
  Json conditions = Json::array();
  for (const SystemNames& names : names_of_systems()) {
    conditions.push_back(
        {{"if", is_system(names.system.name)}, {"then", part_of_mapping(keys, names)}});
  }
  conditions.push_back(condition_of_own(keys));
  return conditions;
}

}  // namespace qsmpc::harness
