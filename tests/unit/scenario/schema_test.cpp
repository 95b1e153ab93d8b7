// The JSON Schema accepts what the reader accepts: the same keys, defaults and ranges.
#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/campaign/plan/campaign_keys.hpp"
#include "harness/campaign/plan/campaign_reader.hpp"
#include "harness/scenario/keys/key_schema.hpp"
#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/shipped_files.hpp"
#include "harness/scenario/yaml_tree.hpp"
#include "harness/text/json_text.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"

namespace qsmpc::harness {
namespace schema_test {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Json = nlohmann::ordered_json;

// As printed by `qsmpc schema`, parsed again.
Json printed(const Json& schema) { return Json::parse(json_text(schema)); }

// Without a plant, so that it has its default as well.
std::string least_text() {
  std::string text = minimal_text;
  const std::string plant = "plant: {kind: analytic, mjcf: \"\"}\n";
  return text.erase(text.find(plant), plant.size());
}

// Every key of `node` that `schema` does not know.
void collect_unknown(const YamlNode& node, const Json& schema, const std::string& path,
                     std::vector<std::string>& unknown) {
  if (node.kind == YamlNode::Kind::kList && schema.contains("items")) {
    for (const YamlNode& item : node.items) {
      collect_unknown(item, schema["items"], path + ".0", unknown);
    }
  }
  if (node.kind != YamlNode::Kind::kMap) return;
  for (std::size_t i = 0; i < node.keys.size(); ++i) {
    const std::string inner = path + "." + node.keys[i];
    if (schema["properties"].contains(node.keys[i])) {
      collect_unknown(node.items[i], schema["properties"][node.keys[i]], inner, unknown);
    } else if (!schema["additionalProperties"].is_object()) {
      unknown.push_back(inner);
    }
  }
}

TEST(ScenarioSchema, has_every_key_of_every_resolved_scenario) {
  const Json schema = printed(scenario_schema());
  std::vector<std::string> unknown;
  for (const ShippedScenario& shipped : shipped_scenarios()) {
    const std::string resolved = to_yaml(load_scenario(shipped.name));
    collect_unknown(parse_yaml(resolved, shipped.name), schema, shipped.name, unknown);
  }
  EXPECT_THAT(unknown, IsEmpty());
  collect_unknown(parse_yaml("controller: {horzon: 3}", "wrong"), schema, "wrong", unknown);
  EXPECT_THAT(unknown, ::testing::ElementsAre("wrong.controller.horzon"));
}

// The schemas of scalar values, with the dotted paths of their keys.
void collect_values(const Json& schema, const std::string& path,
                    std::vector<std::pair<std::string, Json>>& values) {
  if (!schema.contains("properties")) {
    values.emplace_back(path, schema);
    return;
  }
  for (const auto& [key, inner] : schema["properties"].items()) {
    collect_values(inner, path.empty() ? key : path + "." + key, values);
  }
}

std::vector<std::pair<std::string, Json>> values_of(const Json& schema) {
  std::vector<std::pair<std::string, Json>> values;
  collect_values(schema, "", values);
  return values;
}

const YamlNode* find_value(const YamlNode& tree, const std::string& path) {
  const std::size_t dot = path.find('.');
  const YamlNode* node = tree.find(path.substr(0, dot));
  if (dot == std::string::npos || node == nullptr) return node;
  return find_value(*node, path.substr(dot + 1));
}

TEST(ScenarioSchema, has_the_defaults_that_the_reader_fills_in) {
  const YamlNode resolved = parse_yaml(to_yaml(parse_scenario(least_text())), "resolved");
  int compared = 0;
  for (const auto& [path, schema] : values_of(printed(scenario_schema()))) {
    const YamlNode* node = find_value(resolved, path);
    if (node == nullptr || !schema.contains("default")) continue;
    const Json& fallback = schema["default"];
    EXPECT_EQ(node->text, fallback.is_string() ? fallback.get<std::string>() : fallback.dump())
        << path;
    ++compared;
  }
  EXPECT_GT(compared, 25);
}

// Settings under which the key has an effect; otherwise it would be refused as unused.
std::vector<std::string> settings_of(const std::string& path) {
  if (path.starts_with("controller.mppi.")) return {"controller.kind=risk_mppi"};
  if (path.starts_with("controller.shield.")) return {"controller.kind=shield"};
  if (path == "controller.chance.confidence") return {"controller.kind=scenario"};
  if (path == "controller.chance.memory") {
    return {"controller.kind=scenario", "controller.policy=disturbance_feedback"};
  }
  if (path.starts_with("controller.chance.")) return {"controller.kind=drcc"};
  if (path == "target.laps") {
    return {"target={path: [[0, 0], [40, 0], [40, 40], [0, 40]], closed: true}"};
  }
  return {};
}

// The error of the smallest scenario with `value` at `path`; empty if there is none.
std::string refusal_with(const std::string& path, const std::string& value) {
  std::vector<std::string> overrides = settings_of(path);
  overrides.push_back(path + "=" + value);
  try {
    (void)parse_scenario(least_text(), {.overrides = overrides});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ScenarioSchema, has_the_ranges_that_the_reader_holds_values_to) {
  int compared = 0;
  for (const auto& [path, schema] : values_of(printed(scenario_schema()))) {
    // The range of a constant depends on its system, the speed on a path on whether the system has
    // a single speed, and the valid groups on the model file; the others are parts of mappings with
    // more keys.
    const bool stands_alone = !path.starts_with("model.") && !path.starts_with("model_error.") &&
                              path != "target.speed" &&
                              !path.starts_with("safe_set.obstacles_from_mjcf.") &&
                              (!path.starts_with("plant.") || path == "plant.time_step");
    if (!stands_alone) continue;
    for (const char* bound : {"minimum", "maximum"}) {
      if (!schema.contains(bound)) continue;
      const Json& limit = schema[bound];
      EXPECT_EQ(refusal_with(path, limit.dump()), "") << path;
      const double beyond = limit.get<double>() * (limit > 0 ? 2.0 : 1.0) + 1.0;
      const double below = -1.0;
      const double outside = bound == std::string("maximum") ? beyond : below;
      EXPECT_THAT(refusal_with(path, fmt::format("{:.0f}", outside)), HasSubstr(path));
      ++compared;
    }
    if (schema.contains("exclusiveMinimum")) {
      EXPECT_THAT(refusal_with(path, schema["exclusiveMinimum"].dump()), HasSubstr(path));
      ++compared;
    }
  }
  EXPECT_GE(compared, 33);
}

// The keys listed by the error for an unknown one.
std::vector<std::string> listed_keys(const std::string& expected) {
  std::vector<std::string> keys;
  std::string rest = expected.substr(std::string("one of ").size());
  for (std::size_t comma = rest.find(", "); comma != std::string::npos; comma = rest.find(", ")) {
    keys.push_back(rest.substr(0, comma));
    rest.erase(0, comma + 2);
  }
  keys.push_back(rest);
  return keys;
}

std::vector<std::string> names_in(const Json& schema) {
  std::vector<std::string> names;
  for (const auto& [name, inner] : schema["properties"].items()) names.push_back(name);
  return names;
}

TEST(ScenarioSchema, has_the_keys_that_the_reader_knows_in_each_section) {
  const Json schema = printed(scenario_schema());
  const InputError::Where root = refusal_of(least_text() + "zzzzzzzzzzzz: 3\n");
  EXPECT_THAT(listed_keys(root.expected), ::testing::UnorderedElementsAreArray(names_in(schema)));
  for (const char* section :
       {"limit", "video", "plant", "disturbance", "estimator", "controller"}) {
    const InputError::Where where =
        refusal_of(fmt::format("{}{}: {{zzzzzzzzzzzz: 3}}\n", least_text(), section));
    EXPECT_THAT(listed_keys(where.expected),
                ::testing::UnorderedElementsAreArray(names_in(schema["properties"][section])));
  }
}

TEST(ScenarioSchema, knows_for_each_system_its_names_and_sizes) {
  const Json conditions = printed(scenario_schema())["allOf"];
  ASSERT_EQ(conditions.size(), models::systems().size() + 1);
  const Json& bicycle = conditions.at(2);
  EXPECT_EQ(bicycle["if"]["properties"]["model"]["properties"]["system"]["const"], "bicycle");
  const Json& then = bicycle["then"]["properties"];
  EXPECT_EQ(then["initial_state"]["properties"]["mean"]["minItems"], 6);
  EXPECT_EQ(then["controller"]["properties"]["cost"]["properties"]["input"]["maxItems"], 2);
  EXPECT_THAT(then["controller"]["properties"]["input_bounds"]["propertyNames"]["enum"],
              ::testing::ElementsAre("acceleration", "steering_angle"));
  EXPECT_EQ(then["model"]["properties"]["mass"]["default"], 1412.0);
}

TEST(CampaignSchema, has_the_keys_that_the_reader_knows) {
  const Json schema = printed(campaign_schema());
  const YamlNode tree =
      parse_yaml("scenario: a\nseeds: {count: 1, zzzzzzzzzzzz: 2}\nzzzzzzzzzzzz: 3\n", "c.yaml");
  Problems problems("c.yaml");
  (void)read_campaign(tree, "c.yaml", problems);
  const std::vector<InputError::Where> found = problems.sorted();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_THAT(listed_keys(found[0].expected),
              ::testing::UnorderedElementsAreArray(names_in(schema["properties"]["seeds"])));
  EXPECT_THAT(listed_keys(found[1].expected),
              ::testing::UnorderedElementsAreArray(names_in(schema)));
}

}  // namespace schema_test
}  // namespace qsmpc::harness
