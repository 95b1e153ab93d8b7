// The tables of the documentation are those that the program makes, and name every key.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/campaign/plan/campaign_keys.hpp"
#include "harness/contest/contest_keys.hpp"
#include "harness/scenario/keys/key_tables.hpp"
#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/plant_mapping_keys.hpp"
#include "harness/scenario/yaml_tree.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"

namespace qsmpc::harness {
namespace documentation_test {

using ::testing::HasSubstr;

std::string document(const std::string& file) {
  return content_of(std::string(QSMPC_SOURCE_DIR) + "/" + file);
}

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
  const std::string text = document("docs/scenario.md");
  for (const std::string& key : keys) EXPECT_THAT(text, HasSubstr("| `" + documented(key) + "` |"));
}

TEST(Documentation, has_the_tables_that_the_program_makes) {
  std::vector<DocumentTable> tables = scenario_tables();
  for (const DocumentTable& table : campaign_tables()) tables.push_back(table);
  for (const DocumentTable& table : contest_tables()) tables.push_back(table);
  EXPECT_EQ(tables.size(), 11U);
  for (const DocumentTable& table : tables) {
    EXPECT_THAT(document(table.file),
                HasSubstr("<!-- table: " + table.name + " -->\n" + table.text + "\n"))
        << "scripts/document-tables writes it";
  }
}

// The names of all keys within `keys`.
void collect_names(const std::vector<KeyDescription>& keys, std::vector<std::string>& names) {
  for (const KeyDescription& key : keys) {
    if (key.family == NameFamily::kNone && !key.name.empty()) names.push_back(key.name);
    for (const KeyValue& value : key.values) {
      if (const auto* mapping = std::get_if<MappingValue>(&value)) {
        collect_names(mapping->keys, names);
      } else if (const auto* list = std::get_if<ListValue>(&value)) {
        collect_names(list->item, names);
      }
    }
  }
}

TEST(Documentation, names_every_key_of_quantities_and_loops) {
  std::vector<std::string> names;
  collect_names(plant_mapping_keys(), names);
  EXPECT_GT(names.size(), 30U);
  const std::string text = document("docs/plants.md");
  for (const std::string& name : names) {
    EXPECT_THAT(text, ::testing::ContainsRegex("[`{ ]" + name + "[`:},.]"));
  }
}

// Words that list names themselves, since each needs a word of explanation, leave none out.
void expect_all_names_in(const KeyDescription& key) {
  for (const KeyValue& value : key.values) {
    if (const auto* mapping = std::get_if<MappingValue>(&value)) {
      for (const KeyDescription& inner : mapping->keys) expect_all_names_in(inner);
    }
    const auto* name = std::get_if<NameValue>(&value);
    const bool lists_them = name != nullptr && key.words.find("qsmpc list") == std::string::npos &&
                            key.words.find("{names}") == std::string::npos;
    if (!lists_them) continue;
    for (const std::string& known : name->known) {
      EXPECT_THAT(key.words, HasSubstr("`" + known + "`")) << key.name;
    }
  }
}

TEST(Documentation, names_what_a_key_may_be_wherever_no_command_lists_it) {
  for (const ScenarioKey& key : scenario_keys()) {
    if (key.about.name != "plant") expect_all_names_in(describe(key));
  }
}

}  // namespace documentation_test
}  // namespace qsmpc::harness
