#include "harness/campaign/plan/campaign_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace qsmpc::harness {
namespace campaign_plan_test {

using ::testing::HasSubstr;

Campaign two_variants() {
  Campaign campaign{.name = "two",
                    .variants = {},
                    .seeds = {.first = 5, .count = 10},
                    .traces = TraceKeeping::kFailures,
                    .trace_sample = 3};
  campaign.variants.push_back({.name = "fast",
                               .scenario = "a.yaml",
                               .settings = "fast",
                               .overrides = {"limit.steps=3", "controller.horizon=2"},
                               .plant = "mujoco_car",
                               .resolved = {}});
  campaign.variants.push_back({.name = "base",
                               .scenario = "a.yaml",
                               .settings = "base",
                               .overrides = {},
                               .plant = "",
                               .resolved = {}});
  return campaign;
}

TEST(CampaignPlan, has_a_line_for_every_variant_and_the_sizes) {
  EXPECT_EQ(campaign_plan_text(two_variants()),
            "campaign two: 2 variants x 10 seeds = 20 episodes\n"
            "\n"
            "      #  variant  plant       overrides\n"
            "      0  fast     mujoco_car  limit.steps=3 controller.horizon=2\n"
            "      1  base     -           -\n"
            "\n"
            "  seeds     5 to 14\n"
            "  episodes  20\n"
            "  traces    failures, and of each variant the first 3 seeds\n");
}

TEST(CampaignPlan, says_when_it_may_stop_early) {
  Campaign campaign = two_variants();
  EXPECT_FALSE(nlohmann::json::parse(campaign_plan_json(campaign)).contains("until"));
  campaign.until = {.of = "collision", .rate_halfwidth = 0.01, .confidence = 0.995};
  EXPECT_THAT(campaign_plan_text(campaign),
              HasSubstr("  episodes  at most 20\n  until     collision to +-0.01 at 99.5 %\n"));
  const auto until = nlohmann::json::parse(campaign_plan_json(campaign))["until"];
  EXPECT_EQ(until["of"], "collision");
  EXPECT_EQ(until["rate_halfwidth"], 0.01);
  EXPECT_EQ(until["confidence"], 0.995);
}

TEST(CampaignPlan, shows_the_first_of_many_listed_seeds) {
  Campaign campaign = two_variants();
  for (std::uint64_t seed = 100; seed < 112; ++seed) campaign.seeds.listed.push_back(seed);
  EXPECT_THAT(campaign_plan_text(campaign),
              HasSubstr("100, 101, 102, 103, 104, 105, 106, 107, 108, 109, ...\n"));
  campaign.seeds.listed.resize(2);
  EXPECT_THAT(campaign_plan_text(campaign), HasSubstr("100, 101\n"));
}

TEST(CampaignPlan, is_the_same_as_json) {
  const auto json = nlohmann::json::parse(campaign_plan_json(two_variants()));
  EXPECT_EQ(json["campaign"], "two");
  EXPECT_EQ(json["variants"].size(), 2U);
  EXPECT_EQ(json["variants"][0]["overrides"][1], "controller.horizon=2");
  EXPECT_EQ(json["variants"][0]["plant"], "mujoco_car");
  EXPECT_TRUE(json["variants"][1]["plant"].is_null());
  EXPECT_EQ(json["seeds"]["first"], 5);
  EXPECT_EQ(json["seeds"]["count"], 10);
  EXPECT_EQ(json["episodes"], 20);
  EXPECT_EQ(json["traces"], "failures");
  EXPECT_EQ(json["trace_sample"], 3);
}

}  // namespace campaign_plan_test
}  // namespace qsmpc::harness
