// Scenarios of a campaign's variants: their file is read once, and each plant is made once.

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/campaign/plan/variant_scenario.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace variant_scenarios_test {

using namespace testing;

SettingGroup setting(const std::string& key, const std::string& value) {
  const YamlNode node{.kind = YamlNode::Kind::kText, .text = value};
  SettingGroup group{.name = key};
  group.settings = {{.key = key, .value = node, .text = key + "=" + value, .owner = "grid"}};
  return group;
}

TEST(VariantScenarios, read_their_file_once) {
  const TemporaryFolder folder;
  const std::string path = folder.file("mine.yaml", to_yaml(load_scenario("dubins_corridor")));
  Problems problems("campaign.yaml");
  CampaignRefusals refusals("campaign.yaml", problems);
  VariantScenarios scenarios(refusals);
  ASSERT_TRUE(scenarios.load(path, {}));
  std::filesystem::remove(path);
  const auto other = scenarios.load(path, setting("controller.horizon", "5"));
  ASSERT_TRUE(other);
  EXPECT_EQ(other->controller.horizon, 5);
  EXPECT_EQ(scenarios.load(path, {})->controller.horizon, 8) << "no setting stays";
}

TEST(PlantChecks, noise_added_to_the_state_does_not_change_the_plant) {
  const TemporaryFolder folder;
  const std::string vehicle =
      folder.file("body.xml", "<mujoco><worldbody><body/></worldbody></mujoco>");
  Problems problems("campaign.yaml");
  CampaignRefusals refusals("campaign.yaml", problems);
  CampaignDraft draft;
  draft.plants.emplace_back();
  draft.scenarios.emplace_back();
  PlantChecks checks(draft, refusals);
  Scenario scenario = load_scenario("dubins_corridor");
  scenario.plant.mjcf = vehicle;
  const auto chosen = [&](double variance) {
    scenario.disturbance.covariance(1, 1) = variance;
    return checks.choose(scenario, draft.plants.front(), draft.scenarios.front(), {}).has_value();
  };
  EXPECT_TRUE(chosen(0.01));
  // The file is not loaded again: its new contents would be refused.
  (void)folder.file("body.xml", "<mujoco><worldbody><oops/></worldbody></mujoco>");
  EXPECT_TRUE(chosen(0.02));
  scenario.model.parameters["speed"] = 2.0;
  EXPECT_TRUE(chosen(0.02)) << "a vehicle that is only drawn does not depend on the model";
  scenario.plant.kind = "mujoco";
  EXPECT_FALSE(chosen(0.02));
}

}  // namespace variant_scenarios_test
}  // namespace qsmpc::harness
