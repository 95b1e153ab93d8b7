#include "harness/campaign/store/store.hpp"

#include <cmath>
#include <filesystem>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "tests/unit/campaign/store_fixture.hpp"

namespace qsmpc::harness {
namespace store_test {

using ::testing::ElementsAre;
using testing::example_row;
using ::testing::HasSubstr;
using ::testing::Pair;
using testing::quick_campaign;
using StoreTest = testing::StoreFolder;

TEST_F(StoreTest, gives_back_the_episodes_that_were_added_by_seed) {
  {
    Store store = open(testing::quick_campaign());
    store.add(testing::example_row(0, 7), false);
    store.add(testing::example_row(0, 5, "fault"), false);
    store.add(testing::example_row(1, 5, "timeout"), false);
  }
  EpisodeRow fifth = testing::example_row(0, 5, "fault");
  EpisodeRow seventh = testing::example_row(0, 7);
  fifth.periods.clear();
  seventh.periods.clear();
  EXPECT_THAT(rows_of(0), ElementsAre(fifth, seventh));
}

TEST_F(StoreTest, gives_back_the_periods_in_their_order) {
  open(testing::quick_campaign()).add(testing::example_row(1, 6), false);
  std::vector<PeriodRow> periods;
  StoreReader(folder.path())
      .for_each_period(1, [&](std::uint64_t seed, std::int64_t period, const PeriodRow& row) {
        EXPECT_EQ(seed, 6U);
        EXPECT_EQ(period, std::ssize(periods));
        periods.push_back(row);
      });
  EXPECT_EQ(periods, testing::example_row(1, 6).periods);
}

TEST_F(StoreTest, keeps_infinities_and_what_is_not_a_number) {
  EpisodeRow row = testing::example_row(0, 5);
  row.min_clearance = std::numeric_limits<double>::infinity();
  row.cost = std::numeric_limits<double>::quiet_NaN();
  open(testing::quick_campaign()).add(row, false);
  const EpisodeRow again = rows_of(0).front();
  EXPECT_EQ(again.min_clearance, row.min_clearance);
  EXPECT_TRUE(std::isnan(again.cost));
}

TEST_F(StoreTest, pairs_the_episodes_of_two_variants_by_seed) {
  Store store = open(testing::quick_campaign());
  for (const std::uint64_t seed : {8U, 5U, 6U}) store.add(testing::example_row(0, seed), false);
  for (const std::uint64_t seed : {7U, 6U, 8U}) store.add(testing::example_row(1, seed), false);
  std::vector<std::uint64_t> seeds;
  StoreReader(folder.path()).for_each_pair(1, 0, [&](const EpisodeRow& a, const EpisodeRow& b) {
    EXPECT_EQ(a.seed, b.seed);
    EXPECT_EQ(a.variant, 1);
    EXPECT_EQ(b.variant, 0);
    EXPECT_EQ(b.cost, testing::example_row(0, b.seed).cost);
    seeds.push_back(a.seed);
  });
  EXPECT_THAT(seeds, ElementsAre(6U, 8U));
}

TEST_F(StoreTest, shows_the_episodes_of_several_variants_seed_by_seed) {
  Store store = open(testing::quick_campaign());
  for (const std::uint64_t seed : {8U, 5U, 6U}) store.add(testing::example_row(0, seed), false);
  for (const std::uint64_t seed : {7U, 6U, 8U}) store.add(testing::example_row(1, seed), false);
  std::vector<std::string> seen;
  StoreReader(folder.path())
      .for_each_seed({1, 0}, [&](std::uint64_t seed, const std::vector<const EpisodeRow*>& rows) {
        ASSERT_EQ(rows.size(), 2U);
        std::string have;
        for (const EpisodeRow* row : rows) {
          have += row == nullptr ? "-" : fmt::format("{}", row->variant);
          if (row == nullptr) continue;
          EXPECT_EQ(row->seed, seed);
          EXPECT_EQ(row->cost, testing::example_row(row->variant, seed).cost);
        }
        seen.push_back(fmt::format("{}:{}", seed, have));
      });
  EXPECT_THAT(seen, ElementsAre("5:-0", "6:10", "7:1-", "8:10"));
}

TEST_F(StoreTest, sorts_numbers_of_the_episodes_that_have_them) {
  Store store = open(testing::quick_campaign());
  store.add(testing::example_row(0, 7), false);
  store.add(testing::example_row(0, 5), false);
  store.add(testing::example_row(0, 6, "fault"), false);
  store.add(testing::example_row(0, 8, "timeout"), false);
  const StoreReader reader(folder.path());
  std::vector<double> times;
  reader.for_each_sorted(0, EpisodeNumber::kTimeToTarget, [&](double t) { times.push_back(t); });
  EXPECT_THAT(times, ElementsAre(0.5, *testing::example_row(0, 7).time_to_target));
  std::vector<double> clearances;
  reader.for_each_sorted(0, EpisodeNumber::kMinClearance,
                         [&](double c) { clearances.push_back(c); });
  EXPECT_TRUE(std::ranges::is_sorted(clearances));
  EXPECT_EQ(clearances.size(), 3U);
  std::vector<double> times_ms;
  reader.for_each_ocp_ms(0, [&](double t) { times_ms.push_back(t); });
  EXPECT_THAT(times_ms, ElementsAre(1.5, 0.5, 1.5, 0.5, 1.5, 0.5, 1.5, 0.5));
}

TEST_F(StoreTest, never_holds_an_episode_twice) {
  Store store = open(testing::quick_campaign());
  store.add(testing::example_row(0, 5), false);
  EXPECT_THROW(store.add(testing::example_row(0, 5), false), IoError);
  EXPECT_EQ(rows_of(0).size(), 1U);
}

TEST_F(StoreTest, replaces_an_episode_with_its_periods_when_asked) {
  Store store = open(testing::quick_campaign());
  store.add(testing::example_row(0, 5, "fault"), false);
  EpisodeRow shorter = testing::example_row(0, 5);
  shorter.periods.pop_back();
  store.add(shorter, true);
  EXPECT_THAT(store.outcomes(), ElementsAre(Pair("reached", 1)));
  int periods = 0;
  StoreReader(folder.path()).for_each_period(0, [&](auto, auto, const PeriodRow&) { ++periods; });
  EXPECT_EQ(periods, 1);
}

TEST_F(StoreTest, a_reader_sees_one_state_while_episodes_are_added) {
  Store store = open(testing::quick_campaign());
  store.add(testing::example_row(0, 5), false);
  const StoreReader reader(folder.path());
  store.add(testing::example_row(0, 6), false);
  EXPECT_THAT(reader.outcomes(), ElementsAre(Pair("reached", 1)));
  EXPECT_THAT(StoreReader(folder.path()).outcomes(), ElementsAre(Pair("reached", 2)));
}

// Rows of versions with a single outcome for both parts of the unsafe set, in which a drive that
// continued after being unsafe was named by how it ended.
TEST_F(StoreTest, old_drives_that_were_unsafe_have_the_old_outcome_name) {
  Store store = open(testing::quick_campaign(6));
  const auto add = [&](std::uint64_t seed, const char* outcome, bool unsafe) {
    EpisodeRow row = testing::example_row(0, seed, outcome);
    row.unsafe = unsafe;
    store.add(row, false);
  };
  add(5, "reached", false);
  add(6, "reached", true);
  add(7, "timeout", true);
  add(8, "left_safe_set", true);
  add(9, "collision", true);
  add(10, "fault", true);
  EXPECT_EQ(store.outcome(0, 6), "left_safe_set");
  const auto counts = ElementsAre(Pair("collision", 1), Pair("fault", 1), Pair("left_safe_set", 3),
                                  Pair("reached", 1));
  EXPECT_THAT(store.outcomes(), counts);
  const StoreReader reader(folder.path());
  EXPECT_THAT(reader.outcomes(), counts);
  std::vector<std::string> read;
  reader.for_each_episode(0, [&](const EpisodeRow& row) { read.push_back(row.outcome); });
  EXPECT_THAT(read, ElementsAre("reached", "left_safe_set", "left_safe_set", "left_safe_set",
                                "collision", "fault"));
}

TEST_F(StoreTest, counts_what_was_finished_lately) {
  Store store = open(testing::quick_campaign());
  for (const std::uint64_t seed : {5U, 6U, 7U}) store.add(testing::example_row(0, seed), false);
  const StoreReader reader(folder.path());
  EXPECT_EQ(reader.finished_since(0.0), 3);
  EXPECT_EQ(reader.finished_since(testing::example_row(0, 6).timing.finished_at), 2);
}

TEST_F(StoreTest, goes_on_with_the_same_campaign) {
  open(testing::quick_campaign()).add(testing::example_row(0, 5), false);
  const Store again = open(testing::quick_campaign());
  EXPECT_FALSE(again.update().changed);
  EXPECT_EQ(again.outcome(0, 5), "reached");
  EXPECT_EQ(again.outcome(0, 6), std::nullopt);
}

TEST_F(StoreTest, refuses_a_changed_campaign_and_says_what_changed) {
  open(testing::quick_campaign());
  Campaign other = testing::quick_campaign();
  other.name = "slow";
  EXPECT_THAT(refusal(other), HasSubstr("name: found quick, expected slow"));
  EXPECT_THAT(refusal(testing::quick_campaign(9)),
              HasSubstr("seeds: found 5 to 8, expected 5 to 13"));
  EXPECT_THAT(refusal(testing::quick_campaign(), {.index = 1, .count = 2}),
              HasSubstr("--shard: found 1/1, expected 1/2"));
  other = testing::quick_campaign();
  other.traces = TraceKeeping::kAll;
  EXPECT_THAT(refusal(other), HasSubstr("traces: found none, expected all"));
  other = testing::quick_campaign();
  other.variants.pop_back();
  EXPECT_THAT(refusal(other), HasSubstr("variants: found 2 of them, expected 1"));
  other = testing::quick_campaign();
  other.variants[1] = testing::quick_variant("two", 4);
  EXPECT_THAT(refusal(other), HasSubstr("variant two: found   horizon: 2, expected   horizon: 4"));
  EXPECT_THAT(refusal(other), HasSubstr("--update"));
}

// Another version may drive differently, and one campaign is not to be of two kinds.
TEST_F(StoreTest, refuses_what_another_version_of_the_program_has_begun) {
  const Campaign campaign = quick_campaign();
  open(campaign).add(example_row(0, 5), false);
  database().exec("UPDATE campaign SET version = '0.0.9'");
  EXPECT_THAT(refusal(campaign), HasSubstr("version: found qsmpc 0.0.9, expected qsmpc "));
}

// Changes of a figure's families affect no episode.
TEST_F(StoreTest, takes_the_families_of_a_figure_as_they_are_now) {
  Campaign campaign = testing::quick_campaign();
  open(campaign).add(testing::example_row(0, 5), false);
  campaign.risk_against_cost = {{.name = "horizons", .settings = {"two", "three"}},
                                {.name = "one of them", .settings = {"two"}}};
  EXPECT_FALSE(open(campaign).update().changed);
  EXPECT_EQ(StoreReader(folder.path()).campaign().risk_against_cost, campaign.risk_against_cost);
  EXPECT_EQ(rows_of(0).size(), 1U);
  campaign.risk_against_cost.clear();
  (void)open(campaign);
  EXPECT_TRUE(StoreReader(folder.path()).campaign().risk_against_cost.empty());
}

TEST_F(StoreTest, refuses_a_vehicle_that_changed) {
  const Campaign campaign = testing::quick_campaign();
  const auto open_with = [&](const std::string& digest) {
    (void)Store(folder.path(), stored_campaign(campaign, {}),
                stored_variants(campaign, {digest, digest}), campaign.seeds, false);
  };
  open_with("aa");
  EXPECT_NO_THROW(open_with("aa"));
  EXPECT_THROW(open_with("bb"), InputError);
}

TEST_F(StoreTest, an_update_keeps_what_both_campaigns_ask_for_and_drops_the_rest) {
  {
    Store store = open(testing::quick_campaign());
    for (const std::uint64_t seed : {5U, 6U, 8U}) {
      EpisodeRow row = testing::example_row(0, seed);
      row.trace = fmt::format("episodes/0/{}", seed);
      store.add(row, false);
      store.add(testing::example_row(1, seed), false);
    }
  }
  Campaign other = testing::quick_campaign();
  other.seeds = {.first = 6, .count = 2};
  other.variants[1] = testing::quick_variant("two", 4);  // other settings of the same name
  other.variants.insert(other.variants.begin(), testing::quick_variant("new", 5));
  const Store store = open(other, /*update=*/true);
  EXPECT_TRUE(store.update().changed);
  EXPECT_EQ(store.update().kept, 1);
  EXPECT_EQ(store.update().dropped, 5);
  EXPECT_THAT(store.update().traces, ElementsAre("episodes/0/5", "episodes/0/8"));
  ASSERT_EQ(store.variant_ids().size(), 3U);
  EXPECT_EQ(store.variant_ids()[1], 0);  // as before
  EXPECT_EQ(store.outcome(0, 6), "reached");
  EXPECT_EQ(store.outcome(store.variant_ids()[0], 6), std::nullopt);
  EXPECT_EQ(store.outcome(store.variant_ids()[2], 6), std::nullopt);
  const StoreReader reader(folder.path());
  EXPECT_EQ(reader.variants()[0].name, "new");
  EXPECT_EQ(reader.campaign().seeds, "6 to 7");
  EXPECT_EQ(reader.campaign().episodes, 6);
}

TEST_F(StoreTest, an_update_keeps_the_listed_seeds_of_a_shard) {
  Campaign listed = testing::quick_campaign();
  listed.seeds = {.listed = {9, 5, 7, 6}};
  {
    Store store = open(listed);
    for (const std::uint64_t seed : listed.seeds.listed)
      store.add(testing::example_row(0, seed), false);
  }
  const Store store = open(listed, /*update=*/true, {.index = 2, .count = 2});
  EXPECT_EQ(store.update().kept, 2);
  EXPECT_EQ(store.outcome(0, 5), "reached");
  EXPECT_EQ(store.outcome(0, 6), "reached");
  EXPECT_EQ(store.outcome(0, 9), std::nullopt);
}

TEST_F(StoreTest, is_one_file_once_it_is_folded) {
  {
    Store store = open(testing::quick_campaign());
    store.add(testing::example_row(0, 5), false);
    EXPECT_TRUE(std::filesystem::exists(path() + "-wal"));
    store.fold();
    EXPECT_FALSE(std::filesystem::exists(path() + "-wal"));
  }
  EXPECT_EQ(rows_of(0).size(), 1U);
}

TEST_F(StoreTest, is_not_folded_while_others_read_it) {
  Store store = open(testing::quick_campaign());
  store.add(testing::example_row(0, 5), false);
  const StoreReader reader(folder.path());
  EXPECT_THAT(reader.outcomes(), ElementsAre(Pair("reached", 1)));
  EXPECT_NO_THROW(store.fold());
  EXPECT_THAT(reader.outcomes(), ElementsAre(Pair("reached", 1)));
}

}  // namespace store_test
}  // namespace qsmpc::harness
