#include "harness/campaign/statistics/tradeoff.hpp"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/campaign/statistics/campaign_json.hpp"
#include "harness/campaign/statistics/statistics.hpp"
#include "harness/campaign/store/merge.hpp"
#include "harness/campaign/store/store.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/campaign/campaign_fixture.hpp"

namespace qsmpc::harness {
namespace tradeoff_test {

constexpr std::int64_t kDrives = 20;

/// Two scenarios with three settings each, two of which form a family.
Campaign family_campaign() {
  Campaign campaign = testing::quick_campaign(kDrives);
  campaign.variants.clear();
  for (const char* scenario : {"first.yaml", "second.yaml"}) {
    for (const char* settings : {"one", "two", "three"}) {
      CampaignVariant variant = testing::quick_variant(settings);
      variant.scenario = scenario;
      variant.name = fmt::format("{} / {}", scenario, settings);
      campaign.variants.push_back(std::move(variant));
    }
  }
  campaign.risk_against_cost = {{.name = "backwards", .settings = {"three", "one"}}};
  return campaign;
}

/// In each variant the drive n = 1 collides, n = 2 times out, n = 3 faults; the others cost 100 +
/// n. In variant 5 none reaches the target.
void fill(const std::string& folder, const Campaign& campaign, const Shard& part = {}) {
  Store store(folder, stored_campaign(campaign, part),
              stored_variants(campaign, std::vector<std::string>(campaign.variants.size())),
              campaign.seeds, false);
  for (std::int64_t variant = 0; variant < std::ssize(campaign.variants); ++variant) {
    for (std::int64_t n = 0; n < kDrives; ++n) {
      if (!part.has(n)) continue;
      const char* const outcome = n == 1                   ? "collision"
                                  : n == 2 || variant == 5 ? "timeout"
                                  : n == 3                 ? "fault"
                                                           : "reached";
      EpisodeRow row = testing::example_row(variant, campaign.seeds.at(n), outcome);
      row.unsafe = n == 1;
      row.next_step_sum = n == 1 ? 3.0 : 0.01;
      row.cost = n >= 1 && n <= 3 ? 1e9 : 100.0 + static_cast<double>(n);
      store.add(row, false);
    }
  }
}

TEST(Tradeoff, has_a_panel_a_scenario_and_points_in_the_order_of_the_family) {
  const testing::TemporaryFolder folder;
  fill(folder.path(), family_campaign());
  const std::vector<TradeoffPanel> panels = tradeoff_panels(StoreReader(folder.path()));
  ASSERT_EQ(panels.size(), 2U);
  EXPECT_EQ(panels[0].scenario, "first.yaml");
  EXPECT_EQ(panels[1].scenario, "second.yaml");
  ASSERT_EQ(panels[1].families.size(), 1U);
  EXPECT_EQ(panels[1].families[0].name, "backwards");
  ASSERT_EQ(panels[1].families[0].points.size(), 2U);
  EXPECT_EQ(panels[1].families[0].points[0].variant, 5U);
  EXPECT_EQ(panels[1].families[0].points[1].variant, 3U);
}

TEST(Tradeoff, costs_are_of_the_drives_that_reached_the_target) {
  const testing::TemporaryFolder folder;
  fill(folder.path(), family_campaign());
  const std::vector<TradeoffPanel> panels = tradeoff_panels(StoreReader(folder.path()));
  const DriveMean& cost = panels[0].families[0].points[0].cost;
  EXPECT_EQ(cost.drives, kDrives - 3);
  EXPECT_NEAR(cost.mean, 100.0 + (190.0 - 6.0) / 17.0, 1e-12);  // rounding
  EXPECT_LT(cost.interval.lower, cost.mean);
  EXPECT_GT(cost.interval.upper, cost.mean);
  EXPECT_GT(cost.interval.lower, 100.0);
  EXPECT_LT(cost.interval.upper, 119.0);
}

TEST(Tradeoff, adds_up_what_is_certified_of_each_drive) {
  const testing::TemporaryFolder folder;
  fill(folder.path(), family_campaign());
  const std::vector<TradeoffPanel> panels = tradeoff_panels(StoreReader(folder.path()));
  const DriveMean& certified = panels[0].families[0].points[0].certified;
  EXPECT_EQ(certified.drives, kDrives);
  EXPECT_NEAR(certified.mean, (3.0 + 19.0 * 0.01) / 20.0, 1e-12);  // rounding
}

TEST(Tradeoff, of_drives_that_never_reach_the_target_has_no_cost) {
  const testing::TemporaryFolder folder;
  fill(folder.path(), family_campaign());
  const std::vector<TradeoffPanel> panels = tradeoff_panels(StoreReader(folder.path()));
  const DriveMean& cost = panels[1].families[0].points[0].cost;
  EXPECT_EQ(cost.drives, 0);
  EXPECT_TRUE(std::isnan(cost.mean));
  EXPECT_TRUE(std::isnan(cost.interval.lower));
}

TEST(Tradeoff, plants_have_panels_of_their_own) {
  const testing::TemporaryFolder folder;
  Campaign campaign = family_campaign();
  for (std::size_t n = 3; n < 6; ++n) {
    campaign.variants[n].scenario = "first.yaml";
    campaign.variants[n].plant = "mujoco_car";
  }
  fill(folder.path(), campaign);
  const std::vector<TradeoffPanel> panels = tradeoff_panels(StoreReader(folder.path()));
  ASSERT_EQ(panels.size(), 2U);
  EXPECT_EQ(panels[0].plant, "");
  EXPECT_EQ(panels[1].plant, "mujoco_car");
}

TEST(Tradeoff, is_in_the_json_where_the_campaign_asks_for_it) {
  const testing::TemporaryFolder folder;
  Campaign campaign = family_campaign();
  fill(folder.path(), campaign);
  const auto json_now = [&] {
    return nlohmann::json::parse(campaign_json(campaign_statistics(StoreReader(folder.path()))));
  };
  const nlohmann::json json = json_now();
  ASSERT_EQ(json["tradeoff"].size(), 2U);
  EXPECT_EQ(json["tradeoff"][0]["scenario"], "first.yaml");
  const nlohmann::json& point = json["tradeoff"][0]["families"]["backwards"][1];
  EXPECT_EQ(point["variant"], "first.yaml / one");
  EXPECT_EQ(point["settings"], "one");
  EXPECT_EQ(point["done"], kDrives);
  EXPECT_EQ(point["reached"], kDrives - 3);
  EXPECT_EQ(point["timeout"], 1);
  EXPECT_EQ(point["unsafe"], 1);
  EXPECT_DOUBLE_EQ(point["unsafe_rate"], 0.05);
  EXPECT_EQ(point["unsafe_interval"].size(), 2U);
  EXPECT_EQ(point["reached_cost"]["drives"], kDrives - 3);
  EXPECT_EQ(point["certified"]["drives"], kDrives);
  EXPECT_EQ(point["certified"]["interval"].size(), 2U);
  EXPECT_EQ(point["reached_cost"]["interval"].size(), 2U);
  EXPECT_TRUE(json["tradeoff"][1]["families"]["backwards"][0]["reached_cost"]["mean"].is_null());
  campaign.risk_against_cost.clear();
  {
    const Store store(folder.path(), stored_campaign(campaign, {}),
                      stored_variants(campaign, std::vector<std::string>(6)), campaign.seeds,
                      false);
  }
  EXPECT_FALSE(json_now().contains("tradeoff"));
}

TEST(Tradeoff, of_merged_shards_is_that_of_one_run) {
  const testing::TemporaryFolder work;
  const Campaign campaign = family_campaign();
  const auto folder_of = [&](const std::string& name) {
    std::filesystem::create_directories(work / name);
    return work / name;
  };
  fill(folder_of("whole"), campaign);
  fill(folder_of("s1"), campaign, {.index = 1, .count = 2});
  fill(folder_of("s2"), campaign, {.index = 2, .count = 2});
  (void)merge_shards({work / "s2", work / "s1"}, work / "merged");
  EXPECT_EQ(campaign_json(campaign_statistics(StoreReader(work / "merged"))),
            campaign_json(campaign_statistics(StoreReader(work / "whole"))));
}

}  // namespace tradeoff_test
}  // namespace qsmpc::harness
