// Campaigns that look for rare outcomes: file, store, statistics and output.
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/campaign/plan/campaign_plan.hpp"
#include "harness/campaign/rare/rare_scenarios.hpp"
#include "harness/campaign/runner.hpp"
#include "harness/campaign/statistics/campaign_json.hpp"
#include "harness/campaign/statistics/campaign_table.hpp"
#include "harness/campaign/store/merge.hpp"
#include "harness/episode/episode.hpp"
#include "harness/report/campaign_charts.hpp"
#include "harness/report/campaign_page.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/campaign/campaign_fixture.hpp"
#include "tests/unit/campaign/campaign_folder.hpp"
#include "tests/unit/campaign/store_fixture.hpp"

namespace qsmpc::harness {
namespace rare_campaign_test {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::TemporaryFolder;

/// Drives of three periods without a plan, some of which collide.
Campaign rare_campaign(std::int64_t seeds = 4) {
  Scenario scenario = testing::quick_scenario();
  scenario.controller.kind = "lqr";
  std::get<controller::Box>(scenario.safe_set.obstacles.front().form).lower[0] = 0.5;
  return {.name = "seldom",
          .variants = {{.name = "lqr",
                        .scenario = "quick.yaml",
                        .settings = "lqr",
                        .overrides = {},
                        .plant = "",
                        .resolved = parse_scenario(to_yaml(scenario))}},
          .seeds = {.first = 5, .count = seeds},
          .rare = RareSettings{.splitting = {.particles = 10}}};
}

std::vector<RareRow> rows_in(const std::string& folder) {
  std::vector<RareRow> rows;
  StoreReader(folder).for_each_rare(
      0, [&](std::uint64_t, const RareRow& row) { rows.push_back(row); });
  return rows;
}

TEST(RareCampaign, reads_its_keys) {
  const CampaignFolder folder;
  const Campaign campaign = folder.load(
      "scenario: a.yaml\nseeds: [1]\nrare: {particles: 30, killed: 3, floor: 1e-9, certify: "
      "false}\n");
  ASSERT_TRUE(campaign.rare.has_value());
  EXPECT_EQ(campaign.rare->splitting.particles, 30);
  EXPECT_EQ(campaign.rare->splitting.killed, 3);
  EXPECT_EQ(campaign.rare->splitting.floor, 1e-9);
  EXPECT_FALSE(campaign.rare->certify);
  EXPECT_THAT(campaign_plan_text(campaign),
              HasSubstr("30 particles, 3 killed, floor 1e-09, not certified"));
  EXPECT_TRUE(folder.load("scenario: a.yaml\nseeds: [1]\nrare: {}\n").rare.has_value());
  EXPECT_FALSE(folder.load("scenario: a.yaml\nseeds: [1]\n").rare.has_value());
}

TEST(RareCampaign, refuses_what_splitting_cannot_do) {
  const CampaignFolder folder;
  const std::string head = "scenario: a.yaml\nseeds: [1]\n";
  EXPECT_EQ(folder.problem(head + "rare: {particles: 4, killed: 4}\n").key, "rare.killed");
  EXPECT_EQ(folder.problem(head + "rare: {particles: 1}\n").key, "rare.particles");
  EXPECT_EQ(folder.problem(head + "rare: {level: 1}\n").key, "rare.level");
  EXPECT_THAT(folder.problem(head + "variants: {late: {controller.deadline: 1}}\nrare: {}\n").found,
              HasSubstr("controller.deadline"));
  EXPECT_THAT(
      folder.problem(head + "variants: {one: {disturbance.seeds: [{from: 1, seed: 2}]}}\n").found,
      HasSubstr("disturbance.seeds"));
}

TEST(RareCampaign, stores_a_run_for_each_seed_the_same_for_any_number_of_jobs) {
  const TemporaryFolder one;
  const TemporaryFolder three;
  (void)run_campaign(rare_campaign(), one.path(), {.jobs = 1});
  (void)run_campaign(rare_campaign(), three.path(), {.jobs = 3});
  const std::vector<RareRow> rows = rows_in(one.path());
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows, rows_in(three.path()));
  EXPECT_TRUE(std::ranges::any_of(rows, [](const RareRow& row) { return !row.found.empty(); }));
  StoreReader(one.path()).verify();
}

TEST(RareCampaign, resumes_where_it_was_interrupted) {
  const TemporaryFolder whole;
  const TemporaryFolder parts;
  (void)run_campaign(rare_campaign(), whole.path(), {});
  std::atomic<int> asked = 0;
  const CampaignProgress first =
      run_campaign(rare_campaign(), parts.path(), {.should_stop = [&] { return ++asked > 60; }});
  EXPECT_LT(first.done, 4);
  EXPECT_EQ(rows_in(parts.path()).size(), static_cast<std::size_t>(first.done));
  EXPECT_EQ(run_campaign(rare_campaign(), parts.path(), {}).done, 4);
  EXPECT_EQ(rows_in(parts.path()), rows_in(whole.path()));
}

TEST(RareCampaign, is_another_campaign_with_other_settings) {
  const TemporaryFolder folder;
  (void)run_campaign(rare_campaign(2), folder.path(), {});
  Campaign other = rare_campaign(2);
  other.rare->splitting.particles = 12;
  EXPECT_THROW((void)run_campaign(other, folder.path(), {}), InputError);
  other.rare.reset();
  EXPECT_THROW((void)run_campaign(other, folder.path(), {}), InputError);
}

TEST(RareCampaign, is_merged_from_shards) {
  const TemporaryFolder whole;
  const TemporaryFolder first;
  const TemporaryFolder second;
  const TemporaryFolder merged;
  (void)run_campaign(rare_campaign(), whole.path(), {});
  (void)run_campaign(rare_campaign(), first.path(), {.shard = {.index = 1, .count = 2}});
  (void)run_campaign(rare_campaign(), second.path(), {.shard = {.index = 2, .count = 2}});
  (void)merge_shards({first.path(), second.path()}, merged.path());
  EXPECT_EQ(rows_in(merged.path()), rows_in(whole.path()));
}

TEST(RareCampaign, notices_a_store_that_was_changed) {
  const TemporaryFolder folder;
  (void)run_campaign(rare_campaign(2), folder.path(), {});
  SQLite::Database database(folder.path() + "/" + kStoreFile, SQLite::OPEN_READWRITE);
  database.exec("UPDATE rare_run SET probability = probability + 1e-9 WHERE seed = 6");
  EXPECT_THROW(StoreReader(folder.path()).verify(), IoError);
}

TEST(RareCampaign, says_what_it_found_in_table_numbers_page_and_figure) {
  const TemporaryFolder folder;
  (void)run_campaign(rare_campaign(), folder.path(), {});
  const StoreReader store(folder.path());
  const CampaignStatistics statistics = campaign_statistics(store);
  ASSERT_TRUE(statistics.variants.front().rare.has_value());
  const RareStatistics& rare = *statistics.variants.front().rare;
  const nlohmann::json json =
      nlohmann::json::parse(campaign_json(statistics))["variants"]["lqr"]["rare"];
  EXPECT_EQ(json["unsafe"]["mean"], rare.probability);
  EXPECT_EQ(json["unsafe"]["interval"][1], rare.interval.upper);
  EXPECT_EQ(json["worth"]["gain"], rare.gain());
  EXPECT_EQ(json["runs"].size(), 4U);
  EXPECT_THAT(campaign_table(statistics), HasSubstr("Probability of an unsafe drive"));
  EXPECT_THAT(campaign_page(statistics, {}), HasSubstr("Rare outcomes"));
  EXPECT_EQ(campaign_figures(statistics).back().file, kRareFile);
}

TEST(RareCampaign, says_nothing_of_rare_outcomes_where_it_does_not_look_for_them) {
  const TemporaryFolder folder;
  Campaign campaign = rare_campaign(2);
  campaign.rare.reset();
  (void)run_campaign(campaign, folder.path(), {});
  const CampaignStatistics statistics = campaign_statistics(StoreReader(folder.path()));
  EXPECT_FALSE(statistics.variants.front().rare.has_value());
  EXPECT_THAT(campaign_table(statistics), Not(HasSubstr("splitting")));
  EXPECT_THAT(campaign_page(statistics, {}), Not(HasSubstr("Rare outcomes")));
  EXPECT_THAT(campaign_json(statistics), Not(HasSubstr("\"rare\"")));
}

TEST(RareCampaign, writes_scenarios_that_drive_what_it_found) {
  const TemporaryFolder folder;
  (void)run_campaign(rare_campaign(), folder.path(), {});
  const StoreReader store(folder.path());
  write_rare_scenarios(store, folder.path());
  int driven = 0;
  store.for_each_rare(0, [&](std::uint64_t seed, const RareRow& row) {
    for (std::size_t n = 0; n < row.found.size(); ++n) {
      const Scenario scenario =
          load_scenario(folder.path() + "/" + rare_scenario_file(0, seed, n + 1));
      const Trace trace = run_episode(scenario, {.seed = scenario.seed});
      EXPECT_EQ(outcome_name(trace.outcome), row.found[n].outcome);
      EXPECT_EQ(std::ssize(trace.steps), row.found[n].periods);
      ++driven;
    }
  });
  EXPECT_GT(driven, 0);
}

}  // namespace rare_campaign_test
}  // namespace qsmpc::harness
