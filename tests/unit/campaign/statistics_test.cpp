// From a store to the displayed statistics.
#include "harness/campaign/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/campaign/statistics/campaign_csv.hpp"
#include "harness/campaign/statistics/campaign_json.hpp"
#include "harness/campaign/statistics/campaign_table.hpp"
#include "harness/campaign/store/store.hpp"
#include "harness/files/text_file.hpp"
#include "harness/statistics/confidence_sequence.hpp"
#include "harness/text/number_format.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/campaign/campaign_fixture.hpp"

namespace qsmpc::harness {
namespace statistics_test {

using Json = nlohmann::json;

constexpr std::int64_t kSeeds = 20;

/// Two variants with kSeeds seeds; in the second, the last seed is not done and one has faulted.
/// `time` stands for all wall-clock values.
void fill(const std::string& folder, double time = 1.0) {
  Campaign campaign = testing::quick_campaign(kSeeds);
  campaign.variants[1].name = "name, with \"quotes\" and a length that does not fit its column";
  Store store(folder, stored_campaign(campaign, {}), stored_variants(campaign, {"", ""}),
              campaign.seeds, false);
  for (std::int64_t variant = 0; variant < 2; ++variant) {
    for (std::int64_t n = 0; n + variant < kSeeds; ++n) {
      EpisodeRow row = testing::example_row(variant, campaign.seeds.at(n),
                                            variant == 1 && n == 3 ? "fault" : "reached");
      row.cost += variant == 1 ? 0.1 * static_cast<double>(n) : 0.0;
      row.timing = {
          .finished_at = time, .wall_ms = time, .deadline_misses = static_cast<int>(time)};
      for (PeriodRow& period : row.periods) period.ocp_ms *= time;
      store.add(row, false);
    }
  }
}

TEST(CampaignStatistics, say_of_which_variants_no_certificate_is_a_bound) {
  const testing::TemporaryFolder folder;
  Campaign campaign = testing::quick_campaign(1);
  campaign.variants[1].resolved.disturbance.sensor = Eigen::Matrix3d::Identity();
  campaign.variants[1].resolved.estimator.kind = "last_measurement";
  {
    Store store(folder.path(), stored_campaign(campaign, {}), stored_variants(campaign, {"", ""}),
                campaign.seeds, false);
    for (const int variant : {0, 1}) store.add(testing::example_row(variant, 5), false);
  }
  const CampaignStatistics statistics = campaign_statistics(StoreReader(folder.path()));
  EXPECT_EQ(statistics.variants[0].no_bound, "");
  EXPECT_NE(statistics.variants[1].no_bound, "");
  const auto json = Json::parse(campaign_json(statistics));
  EXPECT_EQ(json["variants"]["three"]["certificate"]["holds"], true);
  EXPECT_EQ(json["variants"]["two"]["certificate"]["holds"], false);
  const std::string table = campaign_table(statistics);
  const std::size_t said = table.find("NO BOUND: with measurement noise");
  ASSERT_NE(said, std::string::npos);
  EXPECT_EQ(table.find("NO BOUND", said + 1), std::string::npos);
}

/// Ten seeds, of which the rule used six, unless it has not stopped.
CampaignStatistics statistics_with_a_rule(bool has_stopped) {
  const testing::TemporaryFolder folder;
  Campaign campaign = testing::quick_campaign(10);
  campaign.until = {.of = "timeout", .rate_halfwidth = 0.2, .confidence = 0.8};
  {
    Store store(folder.path(), stored_campaign(campaign, {}), stored_variants(campaign, {"", ""}),
                campaign.seeds, false);
    for (const int variant : {0, 1}) {
      for (std::int64_t n = 0; n < 8; ++n) {
        store.add(
            testing::example_row(variant, campaign.seeds.at(n), n == 2 ? "timeout" : "reached"),
            false);
      }
    }
    if (has_stopped) (void)store.stop_after(campaign.seeds, 6);
  }
  return campaign_statistics(StoreReader(folder.path()));
}

TEST(CampaignStatistics,
     of_a_campaign_with_a_rule_have_intervals_that_hold_at_any_number_of_seeds) {
  const CampaignStatistics statistics = statistics_with_a_rule(true);
  EXPECT_EQ(statistics.done, 12);
  EXPECT_EQ(statistics.campaign.episodes, 12);
  const RateInterval interval = confidence_sequence(1, 6, 0.99);
  EXPECT_EQ(statistics.variants[0].timeout.interval.lower, interval.lower);
  EXPECT_EQ(statistics.variants[0].timeout.interval.upper, interval.upper);
  EXPECT_EQ(statistics.variants[1].unsafe.interval.upper, confidence_sequence(0, 6, 0.99).upper);
}

TEST(CampaignStatistics, say_whether_and_when_a_rule_has_stopped_the_campaign) {
  const CampaignStatistics stopped = statistics_with_a_rule(true);
  const auto until = Json::parse(campaign_json(stopped))["until"];
  EXPECT_EQ(until["of"], "timeout");
  EXPECT_EQ(until["stopped_after"], 6);
  EXPECT_EQ(until["variants"]["two"]["rate"], 1.0 / 6.0);
  EXPECT_EQ(until["variants"]["two"]["interval"][1], confidence_sequence(1, 6, 0.8).upper);
  EXPECT_NE(campaign_table(stopped).find("Stopped by its rule after 6 of at most 10 seeds"),
            std::string::npos);
  const CampaignStatistics going_on = statistics_with_a_rule(false);
  EXPECT_TRUE(Json::parse(campaign_json(going_on))["until"]["stopped_after"].is_null());
  EXPECT_NE(campaign_table(going_on).find("has not stopped it"), std::string::npos);
}

CampaignStatistics filled_statistics(double time = 1.0) {
  const testing::TemporaryFolder folder;
  fill(folder.path(), time);
  return campaign_statistics(StoreReader(folder.path()));
}

/// `json` without the values under `key`, at any depth.
Json without(Json json, const std::string& key) {
  if (json.is_object()) json.erase(key);
  for (Json& entry : json) {
    if (entry.is_structured()) entry = without(entry, key);
  }
  return json;
}

TEST(CampaignStatistics, match_the_rows_of_the_store) {
  const CampaignStatistics statistics = filled_statistics();
  ASSERT_EQ(statistics.variants.size(), 2U);
  EXPECT_EQ(statistics.campaign.episodes, 2 * kSeeds);
  EXPECT_EQ(statistics.done, 2 * kSeeds - 1);
  EXPECT_EQ(statistics.outcomes.at("fault"), 1);
  const VariantStatistics& first = statistics.variants[0];
  EXPECT_EQ(first.episodes, kSeeds);
  EXPECT_EQ(first.done, kSeeds);
  EXPECT_EQ(first.reached.rate, 1.0);
  EXPECT_NEAR(first.cost.mean, 100.0 + 0.1 * (5.0 + 24.0) / 2.0, 1e-12);  // rounding
  EXPECT_DOUBLE_EQ(first.cost.quantiles.front(), 100.5);
  EXPECT_DOUBLE_EQ(first.cost.quantiles.back(), 102.4);
  EXPECT_DOUBLE_EQ(first.time_to_target.quantiles.back(), 2.4);
  EXPECT_EQ(first.periods, 2 * kSeeds);
  EXPECT_EQ(first.unsafe_periods, kSeeds);
  EXPECT_NEAR(first.certified_step_rate(), 1.5e-3, 1e-15);  // rounding
  EXPECT_EQ(first.ocp_ms.median, 0.5);
  EXPECT_EQ(first.ocp_ms.max, 1.5);
  EXPECT_EQ(first.deadline_misses, kSeeds);
  const VariantStatistics& second = statistics.variants[1];
  EXPECT_EQ(second.done, kSeeds - 1);
  EXPECT_EQ(second.cost.count, kSeeds - 2);
  EXPECT_TRUE(std::isinf(second.cost.quantiles.back()));
  EXPECT_TRUE(std::isinf(second.min_clearance.quantiles.front()));
  EXPECT_EQ(second.time_to_target.count, kSeeds - 2);
  EXPECT_LT(statistics.p_value, 1e-9) << "half of the periods are unsafe";
}

TEST(CampaignStatistics, pair_what_both_variants_have_done) {
  const CampaignStatistics statistics = filled_statistics();
  ASSERT_EQ(statistics.differences.size(), 1U);
  const VariantDifference& difference = statistics.differences[0];
  EXPECT_EQ(difference.pair, (VariantPair{1, 0, DiffersBy::kSettings}));
  const MeanDifference& reached = difference.quantities[0];
  EXPECT_EQ(reached.quantity, "reached");
  EXPECT_EQ(reached.pairs, kSeeds - 1);
  EXPECT_DOUBLE_EQ(reached.mean, -1.0 / 19.0);
  const MeanDifference& cost = difference.quantities[2];
  EXPECT_EQ(cost.pairs, kSeeds - 2);
  EXPECT_EQ(cost.left_out, 1);
  // The second variant's costs are higher by 1 + 0.1 n, n = 0 … 18 except 3.
  EXPECT_NEAR(cost.mean, 1.0 + 0.1 * (171.0 - 3.0) / 18.0, 1e-12);  // rounding
  EXPECT_GT(cost.interval.lower, 1.0);
}

TEST(CampaignStatistics, of_a_store_without_episodes_exist) {
  const testing::TemporaryFolder folder;
  const Campaign campaign = testing::quick_campaign(kSeeds);
  {
    const Store store(folder.path(), stored_campaign(campaign, {}),
                      stored_variants(campaign, {"", ""}), campaign.seeds, false);
  }
  const CampaignStatistics statistics = campaign_statistics(StoreReader(folder.path()));
  EXPECT_EQ(statistics.done, 0);
  EXPECT_EQ(statistics.p_value, 1.0);
  const Json json = Json::parse(campaign_json(statistics));
  EXPECT_TRUE(json["variants"]["two"]["reached_rate"].is_null());
  EXPECT_TRUE(json["variants"]["two"]["ocp_ms"]["median"].is_null());
  EXPECT_NE(campaign_table(statistics).find("0 of 40 episodes"), std::string::npos);
}

TEST(CampaignJson, has_the_documented_keys) {
  const Json json = Json::parse(campaign_json(filled_statistics()));
  EXPECT_EQ(json["episodes"], 2 * kSeeds);
  EXPECT_EQ(json["done"], 2 * kSeeds - 1);
  EXPECT_EQ(json["outcomes"]["reached"], 2 * kSeeds - 2);
  const Json& variant = json["variants"]["three"];
  for (const char* key : {"outcomes", "unsafe_step_rate", "certified_step_rate", "ocp_ms",
                          "empirical", "calibration", "cost", "differences"}) {
    EXPECT_TRUE(variant.contains(key)) << key;
  }
  for (const char* outcome : {"reached", "collision", "left_bounds", "timeout", "fault"}) {
    EXPECT_TRUE(variant[outcome + std::string("_rate")].is_number()) << outcome;
    EXPECT_EQ(variant[outcome + std::string("_interval")].size(), 2U) << outcome;
  }
  for (const char* key : {"median", "p95", "p99", "max", "mean", "deadline_misses"}) {
    EXPECT_TRUE(variant["ocp_ms"].contains(key)) << key;
  }
  EXPECT_EQ(variant["empirical"]["unsafe_interval"].size(), 2U);
  EXPECT_EQ(variant["calibration"]["certified"].size(), 1U) << "bins without periods are left out";
  const auto second = std::next(json["variants"].begin());
  const Json& faulted = (second.key() == "three" ? json["variants"].begin() : second).value();
  EXPECT_TRUE(faulted["cost"]["max"].is_null());
  EXPECT_TRUE(faulted["min_clearance"]["min"].is_null());
  EXPECT_EQ(faulted["cost"]["faults"], 1);
  EXPECT_EQ(faulted["differences"][0]["baseline"], "three");
  EXPECT_EQ(faulted["differences"][0]["cost"]["pairs"], kSeeds - 2);
}

TEST(CampaignJson, keeps_wall_clock_under_one_key) {
  const Json one = Json::parse(campaign_json(filled_statistics(1.0)));
  const Json other = Json::parse(campaign_json(filled_statistics(7.0)));
  EXPECT_NE(one, other);
  EXPECT_EQ(without(one, "ocp_ms"), without(other, "ocp_ms"));
}

TEST(CampaignTable, keeps_its_lines_short_and_marks_names_that_it_cuts) {
  const std::string table = campaign_table(filled_statistics());
  std::istringstream lines(table);
  std::string line;
  while (std::getline(lines, line)) {
    const auto columns = std::ranges::count_if(
        line, [](char letter) { return (static_cast<unsigned char>(letter) & 0xC0U) != 0x80U; });
    EXPECT_LE(columns, 110) << line;
  }
  EXPECT_NE(table.find("name, with \"quotes\" and a …"), std::string::npos);
  EXPECT_NE(table.find("39 of 40 episodes"), std::string::npos);
  EXPECT_EQ(table.find("nan"), std::string::npos);
  EXPECT_EQ(table.find("inf"), std::string::npos);
}

TEST(CampaignTable, says_first_what_became_of_the_drives) {
  CampaignStatistics statistics = filled_statistics();
  statistics.outcomes = {{"collision", 30}, {"reached", 9}};
  VariantTally tally;
  for (int n = 0; n < 40; ++n) {
    tally.add({.outcome = n < 30 ? "collision" : "reached", .unsafe = n < 30});
  }
  statistics.variants[0] = tally.result();
  const std::string table = campaign_table(statistics);
  EXPECT_NE(table.find("  9 reached (23.1 %), 30 collision (76.9 %)\n"), std::string::npos);
  const std::size_t head =
      table.find("reached     collision   left bounds       timeout         fault");
  ASSERT_NE(head, std::string::npos) << table;
  EXPECT_LT(head, table.find("Next-step certificates"));
  EXPECT_NE(table.find("     25            75             0             0             0\n"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find(fmt::format("[{}, {}]", format_percent(clopper_pearson(30, 40, 0.005).lower),
                                   format_percent(clopper_pearson(30, 40, 0.005).upper))),
            std::string::npos);
}

/// Number of fields of a line, respecting quotes.
std::size_t field_count(const std::string& line) {
  std::size_t count = 1;
  bool quoted = false;
  for (const char letter : line) {
    quoted = quoted != (letter == '"');
    count += letter == ',' && !quoted ? 1 : 0;
  }
  return count;
}

TEST(CampaignCsv, has_four_columns_of_each_outcome) {
  const std::string csv = variants_csv(filled_statistics());
  for (const char* name : {"reached", "collision", "left_bounds", "timeout", "fault", "unsafe"}) {
    EXPECT_NE(csv.find(fmt::format(",{0},{0}_rate,{0}_interval.lower,{0}_interval.upper,", name)),
              std::string::npos)
        << name;
  }
}

TEST(CampaignCsv, every_line_has_the_fields_of_its_head) {
  const CampaignStatistics statistics = filled_statistics();
  for (const std::string& csv :
       {variants_csv(statistics), differences_csv(statistics), calibration_csv(statistics)}) {
    std::istringstream lines(csv);
    std::string head;
    std::getline(lines, head);
    std::string line;
    int count = 0;
    for (; std::getline(lines, line); ++count) EXPECT_EQ(field_count(line), field_count(head));
    EXPECT_GE(count, 2);
    EXPECT_EQ(csv.find("nan"), std::string::npos);
    EXPECT_EQ(csv.find("inf,"), std::string::npos);
  }
}

TEST(CampaignCsv, has_every_episode_with_numbers_that_read_back_as_they_were) {
  const testing::TemporaryFolder folder;
  fill(folder.path());
  write_episodes_csv(StoreReader(folder.path()), folder / "episodes.csv");
  std::istringstream lines(read_text_file(folder / "episodes.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line + "\n", episodes_csv_head());
  const std::size_t fields = field_count(line);
  std::vector<std::string> rows;
  while (std::getline(lines, line)) rows.push_back(line);
  ASSERT_EQ(rows.size(), static_cast<std::size_t>(2 * kSeeds - 1));
  for (const std::string& row : rows) EXPECT_EQ(field_count(row), fields) << row;
  EXPECT_TRUE(rows[0].starts_with("three,5,reached,,2,0.5,0,")) << rows[0];
  EXPECT_TRUE(rows[3 + kSeeds].starts_with("\"name, with \"\"quotes\"\"")) << rows[3 + kSeeds];
  StoredVariant variant;
  EpisodeRow row = testing::example_row(0, 1);
  row.cost = 0.1 + 0.2;
  EXPECT_NE(episodes_csv_line(variant, row).find(",0.30000000000000004,"), std::string::npos);
}

}  // namespace statistics_test
}  // namespace qsmpc::harness
