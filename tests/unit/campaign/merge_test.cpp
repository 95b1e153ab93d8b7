#include "harness/campaign/store/merge.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/campaign/runner.hpp"
#include "harness/campaign/store/joined_store.hpp"
#include "harness/campaign/store/store.hpp"
#include "harness/errors.hpp"
#include "harness/trace/trace_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/campaign/campaign_fixture.hpp"

namespace qsmpc::harness {
namespace merge_test {

namespace fs = std::filesystem;
using testing::example_row;
using ::testing::HasSubstr;
using testing::quick_campaign;
using testing::TemporaryFolder;

class Merge : public ::testing::Test {
 protected:
  /// A shard of made-up rows: all of its seeds except `without`.
  std::string shard(const Campaign& campaign, const Shard& part,
                    const std::vector<std::uint64_t>& without = {}) {
    const std::string folder = work / fmt::format("shard{}", ++made);
    fs::create_directories(folder);
    Store store(folder, stored_campaign(campaign, part),
                stored_variants(campaign, std::vector<std::string>(campaign.variants.size())),
                campaign.seeds, false);
    for (std::size_t v = 0; v < campaign.variants.size(); ++v) {
      for (std::int64_t i = 0; i < campaign.seeds.size(); ++i) {
        const std::uint64_t seed = campaign.seeds.at(i);
        if (!part.has(i) || std::ranges::find(without, seed) != without.end()) continue;
        store.add(testing::example_row(store.variant_ids()[v], seed), false);
      }
    }
    return folder;
  }
  std::string refusal(const std::vector<std::string>& folders) const {
    try {
      merge_shards(folders, out());
    } catch (const InputError& error) {
      EXPECT_FALSE(fs::exists(out() + "/campaign.sqlite"));
      EXPECT_FALSE(fs::exists(out() + "/campaign.sqlite.partial"));
      return error.what();
    }
    return "not refused";
  }
  std::string out() const { return work / "merged"; }

  TemporaryFolder work;
  int made = 0;
};

TEST_F(Merge, joins_what_shards_drove_into_what_one_run_drives) {
  Campaign campaign = testing::quick_campaign(5);
  campaign.traces = TraceKeeping::kAll;
  const TemporaryFolder whole;
  (void)run_campaign(campaign, whole.path(), {});
  for (const std::int64_t index : {1, 2}) {
    (void)run_campaign(campaign, work / fmt::format("s{}", index),
                       {.shard = {.index = index, .count = 2}});
  }
  const MergeResult merged = merge_shards({work / "s2", work / "s1"}, out());
  EXPECT_EQ(merged.episodes, 10);
  EXPECT_EQ(merged.traces, 10);
  {
    const StoreReader one(whole.path());
    const StoreReader both(out());
    EXPECT_EQ(both.campaign(), one.campaign());
    EXPECT_EQ(both.variants(), one.variants());
    for (const StoredVariant& variant : one.variants()) {
      const auto rows_of = [&](const StoreReader& store) {
        std::vector<EpisodeRow> rows;
        store.for_each_episode(variant.id, [&](EpisodeRow row) {
          row.timing = {};
          rows.push_back(row);
        });
        std::size_t periods = 0;
        store.for_each_period(variant.id, [&](auto, auto, const PeriodRow& row) {
          rows.at(0).periods.push_back(row);
          rows[0].periods.back().ocp_ms = 0.0;
          ++periods;
        });
        EXPECT_GT(periods, 0U);
        return rows;
      };
      EXPECT_EQ(rows_of(both), rows_of(one));
      both.for_each_episode(variant.id, [&](const EpisodeRow& row) {
        EXPECT_EQ(read_trace(out() + "/" + row.trace + "/episode.h5").seed, row.seed);
      });
    }
  }
  // A merged campaign counts as done.
  EXPECT_EQ(run_campaign(campaign, out(), {}).fresh, 0);
}

TEST_F(Merge, variants_may_be_numbered_differently) {
  const Campaign campaign = testing::quick_campaign(2);
  Campaign before = campaign;
  before.variants = {testing::quick_variant("old", 5), campaign.variants[1]};
  const std::string first = shard(before, {.index = 1, .count = 2});
  {
    Store store(first, stored_campaign(campaign, {.index = 1, .count = 2}),
                stored_variants(campaign, {"", ""}), campaign.seeds, /*update=*/true);
    ASSERT_EQ(store.variant_ids(), (std::vector<std::int64_t>{2, 1}));
    store.add(testing::example_row(2, 5), false);
  }
  merge_shards({shard(campaign, {.index = 2, .count = 2}), first}, out());
  const StoreReader merged(out());
  ASSERT_EQ(merged.variants()[0].name, "three");
  std::vector<double> costs;
  merged.for_each_episode(merged.variants()[0].id,
                          [&](const EpisodeRow& row) { costs.push_back(row.cost); });
  EXPECT_EQ(costs, (std::vector<double>{testing::example_row(2, 5).cost,
                                        testing::example_row(0, 6).cost}));
}

TEST_F(Merge, says_which_shard_is_missing) {
  const Campaign campaign = testing::quick_campaign();
  const std::string first = shard(campaign, {.index = 1, .count = 3});
  const std::string third = shard(campaign, {.index = 3, .count = 3});
  EXPECT_THAT(refusal({first, third}), HasSubstr("without shard 2/3"));
}

TEST_F(Merge, says_which_shard_is_double) {
  const Campaign campaign = testing::quick_campaign();
  const std::string first = shard(campaign, {.index = 1, .count = 2});
  const std::string same = shard(campaign, {.index = 1, .count = 2});
  const std::string second = shard(campaign, {.index = 2, .count = 2});
  EXPECT_THAT(refusal({first, second, same}), HasSubstr("shard 1/2, which " + first));
  EXPECT_THAT(refusal({first, second, second}), HasSubstr("shard 2/2, which " + second));
}

TEST_F(Merge, says_which_episode_is_missing) {
  const Campaign campaign = testing::quick_campaign();
  const std::string first = shard(campaign, {.index = 1, .count = 2}, {7});
  EXPECT_THAT(refusal({first, shard(campaign, {.index = 2, .count = 2})}),
              HasSubstr("variant three: found no episode with seed 7"));
}

TEST_F(Merge, says_which_episode_is_double) {
  const Campaign campaign = testing::quick_campaign();
  const std::string second = shard(campaign, {.index = 2, .count = 2});
  {
    Store store(second, stored_campaign(campaign, {.index = 2, .count = 2}),
                stored_variants(campaign, {"", ""}), campaign.seeds, false);
    store.add(testing::example_row(1, 5), false);
  }
  EXPECT_THAT(refusal({shard(campaign, {.index = 1, .count = 2}), second}),
              HasSubstr("found variant two, seed 5, which another shard also has"));
}

TEST_F(Merge, says_which_episode_is_foreign) {
  const Campaign campaign = testing::quick_campaign();
  const std::string only = shard(campaign, {});
  {
    Store store(only, stored_campaign(campaign, {}), stored_variants(campaign, {"", ""}),
                campaign.seeds, false);
    store.add(testing::example_row(1, 99), false);
  }
  EXPECT_THAT(
      refusal({only}),
      HasSubstr("variant two: found an episode with seed 99, which is not one of the campaign's"));
}

TEST_F(Merge, takes_listed_seeds_in_any_order) {
  Campaign campaign = testing::quick_campaign();
  campaign.seeds = {.listed = {9, 2, 30, 4}};
  const MergeResult merged = merge_shards(
      {shard(campaign, {.index = 1, .count = 2}), shard(campaign, {.index = 2, .count = 2})},
      out());
  EXPECT_EQ(merged.episodes, 8);
}

TEST_F(Merge, refuses_shards_of_other_campaigns) {
  Campaign other = testing::quick_campaign();
  other.name = "other";
  const std::string first = shard(testing::quick_campaign(), {.index = 1, .count = 2});
  EXPECT_THAT(refusal({first, shard(other, {.index = 2, .count = 2})}),
              HasSubstr("name: found other, expected quick"));
  const std::string newer = shard(testing::quick_campaign(), {.index = 2, .count = 2});
  SQLite::Database(newer + "/campaign.sqlite", SQLite::OPEN_READWRITE)
      .exec("UPDATE campaign SET version = '99.0'");
  EXPECT_THAT(refusal({first, newer}),
              HasSubstr(fmt::format("version: found 99.0, expected {}",
                                    stored_campaign(testing::quick_campaign(), {}).version)));
  other = testing::quick_campaign();
  other.variants[0] = testing::quick_variant("three", 4);
  EXPECT_THAT(refusal({first, shard(other, {.index = 2, .count = 2})}),
              HasSubstr("variant three: found another scenario"));
  other = testing::quick_campaign();
  other.risk_against_cost = {{.name = "horizons", .settings = {"two", "three"}}};
  EXPECT_THAT(refusal({first, shard(other, {.index = 2, .count = 2})}),
              HasSubstr("figure.risk_against_cost: found horizons: two, three, expected none"));
}

/// A store of the episodes of `seeds` in its own folder.
class MergeOfParts : public Merge {
 protected:
  std::string part(const std::vector<std::uint64_t>& seeds, double more_cost = 0.0,
                   double later = 0.0) {
    const std::string folder = work / fmt::format("part{}", ++made);
    fs::create_directories(folder);
    Store store(folder, stored_campaign(campaign, {}), stored_variants(campaign, {"", ""}),
                campaign.seeds, false);
    for (const std::int64_t variant : {0, 1}) {
      for (const std::uint64_t seed : seeds) {
        EpisodeRow row = testing::example_row(variant, seed);
        row.cost += more_cost;
        row.timing.finished_at += later;
        row.periods[0].ocp_ms += later;
        store.add(row, false);
      }
    }
    return folder;
  }
  std::string refusal_of_parts(const std::vector<std::string>& folders, const MergePolicy& policy) {
    try {
      merge_stores(folders, out(), policy);
    } catch (const InputError& error) {
      EXPECT_FALSE(fs::exists(out() + "/campaign.sqlite"));
      return error.what();
    }
    return "not refused";
  }
  std::vector<double> ends(std::int64_t variant) const {
    std::vector<double> ends;
    StoreReader(out()).for_each_episode(
        variant, [&](const EpisodeRow& row) { ends.push_back(row.timing.finished_at); });
    return ends;
  }

  Campaign campaign = testing::quick_campaign();  // seeds 5 to 8
};

TEST_F(MergeOfParts, takes_an_episode_that_several_have_once_and_from_the_first) {
  const MergeResult merged =
      merge_stores({part({5, 6}), part({6, 7}, 0.0, 50.0), part({8})}, out(), {.duplicates = true});
  EXPECT_EQ(merged.episodes, 8);
  EXPECT_EQ(merged.asked, 8);
  EXPECT_EQ(ends(1)[1], testing::example_row(1, 6).timing.finished_at);
  EXPECT_EQ(ends(1)[2], testing::example_row(1, 7).timing.finished_at + 50.0);
  EXPECT_NO_THROW(StoreReader(out()).verify());
}

TEST_F(MergeOfParts, comes_out_the_same_however_many_episodes_are_copied_at_a_time) {
  const std::vector<std::string> parts{part({5, 8}), part({6, 8}, 0.0, 50.0), part({7})};
  const auto merged = [&](std::int64_t at_a_time) {
    merge_stores(parts, out(),
                 {.duplicates = true, .replace = true, .episodes_at_a_time = at_a_time});
    StoreReader(out()).verify();
    std::vector<EpisodeRow> rows;
    for (const std::int64_t variant : {0, 1}) {
      StoreReader(out()).for_each_episode(variant,
                                          [&](const EpisodeRow& row) { rows.push_back(row); });
    }
    return rows;
  };
  const std::vector<EpisodeRow> whole = merged(1000);
  EXPECT_EQ(whole.size(), 8U);
  for (const std::int64_t at_a_time : {1, 2, 3, 4, 7}) EXPECT_EQ(merged(at_a_time), whole);
}

TEST_F(MergeOfParts, says_which_episode_is_double_or_foreign_in_each_pass) {
  EXPECT_THAT(refusal_of_parts({part({5, 6}), part({6, 7, 8})}, {.episodes_at_a_time = 1}),
              HasSubstr("seed 6, which another shard also has"));
  for (const std::uint64_t foreign : {4U, 9U}) {
    EXPECT_THAT(
        refusal_of_parts({part({5, foreign})}, {.incomplete = true, .episodes_at_a_time = 1}),
        HasSubstr(fmt::format("seed {}, which is not one of the campaign's", foreign)));
  }
}

TEST(KeyRanges, follow_one_another_and_leave_nothing_out) {
  const auto whole = [](const KeyRange& range) {
    return range.first_seed == std::numeric_limits<std::int64_t>::min() &&
           range.last_seed == std::numeric_limits<std::int64_t>::max();
  };
  const std::vector<KeyRange> groups = key_ranges(5, {.first = 3, .count = 10}, 25);
  ASSERT_EQ(groups.size(), 3U);  // of two variants, and the last one
  EXPECT_EQ(groups[1].first_variant, 2);
  EXPECT_EQ(groups[2].last_variant, 4);
  EXPECT_TRUE(std::ranges::all_of(groups, whole));
  // The last two seeds are stored as negative numbers.
  const SeedSet listed{.listed = {7, 1, 30, 9, std::uint64_t(-2), std::uint64_t(-5)}};
  const std::vector<KeyRange> parts = key_ranges(1, listed, 2);
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts.front().first_seed, std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(parts[0].last_seed, 0);
  EXPECT_EQ(parts[1].first_seed, 1);
  EXPECT_EQ(parts[1].last_seed, 8);
  EXPECT_EQ(parts[2].first_seed, 9);
  EXPECT_EQ(parts.back().last_seed, std::numeric_limits<std::int64_t>::max());
}

// SQLite opens them by URI.
TEST_F(MergeOfParts, finds_stores_in_folders_of_any_name) {
  const std::string named = work / "50%25 of 2? #1&mode=rw;é";
  fs::rename(part({5, 6}), named);
  EXPECT_EQ(merge_stores({part({7, 8}), named}, out(), {}).episodes, 8);
  EXPECT_EQ(ends(1)[1], testing::example_row(1, 6).timing.finished_at);
}

TEST_F(MergeOfParts, refuses_episodes_that_contradict_each_other) {
  EXPECT_THAT(refusal_of_parts({part({5, 6}), part({6, 7}, 1e-9), part({8})}, {.duplicates = true}),
              HasSubstr("variant three, seed 6: found a row of table episode that differs from "
                        "that of an earlier folder"));
}

TEST_F(MergeOfParts, says_which_episode_is_double_or_missing_unless_that_is_allowed) {
  EXPECT_THAT(refusal_of_parts({part({5, 6}), part({6, 7, 8})}, {}),
              HasSubstr("seed 6, which another shard also has"));
  EXPECT_THAT(refusal_of_parts({part({5, 6}), part({6, 8})}, {.duplicates = true}),
              HasSubstr("found no episode with seed 7"));
  const MergeResult merged =
      merge_stores({part({5, 6}), part({6, 8})}, out(), {.duplicates = true, .incomplete = true});
  EXPECT_EQ(merged.episodes, 6);
  EXPECT_EQ(merged.asked, 8);
}

TEST_F(MergeOfParts, refuses_foreign_seeds_also_where_episodes_may_be_missing) {
  for (const std::uint64_t foreign : {4U, 9U}) {
    EXPECT_THAT(refusal_of_parts({part({5, foreign})}, {.incomplete = true}),
                HasSubstr(fmt::format("seed {}, which is not one of the campaign's", foreign)));
  }
}

TEST_F(MergeOfParts, a_store_may_be_replaced_by_what_it_is_a_part_of) {
  const MergePolicy policy{.duplicates = true, .incomplete = true, .replace = true};
  EXPECT_EQ(merge_stores({part({})}, out(), policy).episodes, 0);
  EXPECT_EQ(merge_stores({out(), part({5})}, out(), policy).episodes, 2);
  {
    // Its log is not mistaken for that of the store that replaces it.
    Store store(out(), stored_campaign(campaign, {}), stored_variants(campaign, {"", ""}),
                campaign.seeds, false);
    store.add(testing::example_row(0, 8), false);
  }
  EXPECT_EQ(merge_stores({out(), part({5, 6})}, out(), policy).episodes, 5);
  EXPECT_NO_THROW(StoreReader(out()).verify());
  EXPECT_EQ(ends(0).size(), 3U);
}

TEST_F(MergeOfParts, names_the_folder_in_which_an_episode_is_damaged) {
  const std::string sound = part({5, 6});
  const std::string damaged = part({7, 8});
  SQLite::Database(damaged + "/campaign.sqlite", SQLite::OPEN_READWRITE)
      .exec("UPDATE episode SET cost = cost + 1 WHERE seed = 8 AND variant = 0");
  try {
    merge_stores({sound, damaged}, out(), {});
    FAIL() << "not refused";
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr(damaged));
    EXPECT_THAT(error.what(), HasSubstr("seed 8"));
  }
  EXPECT_FALSE(fs::exists(out() + "/campaign.sqlite"));
}

TEST_F(Merge, never_writes_over_a_campaign) {
  const std::string only = shard(testing::quick_campaign(), {});
  merge_shards({only}, out());
  EXPECT_THROW(merge_shards({only}, out()), InputError);
  EXPECT_EQ(StoreReader(out()).campaign().episodes, 8);
}

}  // namespace merge_test
}  // namespace qsmpc::harness
