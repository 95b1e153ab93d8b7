// Campaign files through the program: listed and validated.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/process.hpp"

namespace qsmpc::harness {
namespace integration_campaign_file_test {

using namespace testing;

using ::testing::HasSubstr;

TEST(CampaignFiles, are_listed_with_their_descriptions) {
  const auto json = nlohmann::json::parse(run_qsmpc({"list", "campaigns", "--json"}).output);
  ASSERT_GE(json["campaigns"].size(), 4U);
  for (const auto& campaign : json["campaigns"]) EXPECT_NE(campaign["summary"], "");
}

TEST(CampaignFiles, are_validated_beside_scenarios) {
  const ProcessResult both = run_qsmpc({"validate", "dubins_corridor", "dubins_policies"});
  EXPECT_EQ(both.exit_code, 0);
  EXPECT_EQ(both.output,
            "dubins_corridor: ok\n"
            "dubins_policies: campaign dubins_policies: 4 variants x 200 seeds = 800 episodes, "
            "ok\n");
  const auto json =
      nlohmann::json::parse(run_qsmpc({"validate", "dubins_plants", "--json"}).output);
  EXPECT_EQ(json["ok"], true);
  EXPECT_EQ(json["campaign"]["variants"], 3);
  EXPECT_EQ(json["campaign"]["episodes"], 300);
}

TEST(CampaignFiles, that_are_wrong_are_a_bad_input_with_every_problem) {
  const TemporaryFolder folder;
  const std::string file = folder.file("wrong.yaml",
                                       "scenario: dubins_corridor\n"
                                       "variants:\n"
                                       "  fast: {controller.horizon: 0}\n"
                                       "plants: [analytic, mujoco_cat]\n"
                                       "seeds: {first: 0}\n");
  const ProcessResult result = run_qsmpc({"validate", file});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr(file + ":3: variants.fast.controller.horizon: found 0"));
  EXPECT_THAT(result.output, HasSubstr(file + ":4: plants.1: found mujoco_cat"));
  EXPECT_THAT(result.output, HasSubstr(file + ":5: seeds.count: found nothing"));
  const auto json = nlohmann::json::parse(run_qsmpc({"validate", file, "--json"}).output);
  EXPECT_EQ(json["ok"], false);
  EXPECT_FALSE(json.contains("campaign"));
  EXPECT_EQ(json["errors"][0]["file"], file);
}

}  // namespace integration_campaign_file_test
}  // namespace qsmpc::harness
