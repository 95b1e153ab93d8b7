// docs/scenario.md and the reader agree on which keys there are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scenario/yaml_tree.hpp"
#include "models/dynamics/dynamics.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"

namespace qsmpc::harness {
namespace documentation_test {

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
  const Scenario scenario = parse_scenario(
      minimal_text,
      {.overrides = {"controller.kind=lqr", "controller.feedback_gain=[1, 2, 3]",
                     "controller.deadline=1",
                     "model_error={mean: [0, 0, 0], covariance: [0, 0, 0], rms: [0, 0, 0], "
                     "norm4: [0, 0, 0], norm8: [0, 0, 0], offset: [0, 0, 0], radius: 0, "
                     "first: [{rms: [0, 0, 0]}]}"}});
  std::vector<std::string> keys;
  collect_keys(parse_yaml(to_yaml(scenario), "resolved"), "", keys);
  EXPECT_GT(keys.size(), 35U);
  for (const std::string& key : keys) {
    EXPECT_THAT(document, ::testing::HasSubstr("| `" + documented(key) + "` |"));
  }
}

TEST(Documentation, names_every_system_with_its_states_inputs_and_constants) {
  const std::string document = content_of(std::string(QSMPC_SOURCE_DIR) + "/docs/scenario.md");
  for (const models::SystemEntry& entry : models::systems()) {
    const std::size_t begin = document.find("\n| `" + entry.name + "` |");
    ASSERT_NE(begin, std::string::npos) << entry.name;
    const std::string row = document.substr(begin, document.find('\n', begin + 1) - begin);
    const auto model = models::make_dynamics(entry.name, {}, 0.1);
    for (const models::Coordinate& state : model->description().states) {
      EXPECT_THAT(row, ::testing::HasSubstr("`" + state.name + "`"));
    }
    for (const models::Coordinate& input : model->description().inputs) {
      EXPECT_THAT(row, ::testing::HasSubstr("`" + input.name + "`"));
    }
    for (const auto& [name, value] : entry.defaults) {
      EXPECT_THAT(row, ::testing::HasSubstr("`" + name + "`"));
    }
  }
}

}  // namespace documentation_test
}  // namespace qsmpc::harness
