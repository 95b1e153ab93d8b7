// docs/scenario.md and the reader agree on which keys there are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scenario/yaml_tree.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"

namespace qsmpc {
namespace {

// The dotted paths of everything that is not a mapping.
void collect_keys(const YamlNode& node, const std::string& path, std::vector<std::string>& keys) {
  if (node.kind != YamlNode::Kind::kMap) {
    keys.push_back(path);
    return;
  }
  for (std::size_t i = 0; i < node.keys.size(); ++i) {
    collect_keys(node.items[i], path.empty() ? node.keys[i] : path + "." + node.keys[i], keys);
  }
}

// As the document writes it, with a word in capitals for what the system names.
std::string documented(const std::string& key) {
  const std::string family = key.substr(0, key.rfind('.') + 1);
  if (family == "safe_set.bounds.") return family + "STATE";
  if (family == "controller.input_bounds.") return family + "INPUT";
  if (family == "model." && key != "model.system") return family + "PARAMETER";
  return key;
}

TEST(Documentation, describes_every_key_that_a_resolved_scenario_has) {
  const std::string document = content_of(std::string(QSMPC_SOURCE_DIR) + "/docs/scenario.md");
  const Scenario scenario =
      parse_scenario(minimal_text, {.overrides = {"controller.feedback_gain=[1, 2, 3]"}});
  std::vector<std::string> keys;
  collect_keys(parse_yaml(to_yaml(scenario), "resolved"), "", keys);
  EXPECT_GT(keys.size(), 35U);
  for (const std::string& key : keys) {
    EXPECT_THAT(document, ::testing::HasSubstr("| `" + documented(key) + "` |"));
  }
}

}  // namespace
}  // namespace qsmpc
