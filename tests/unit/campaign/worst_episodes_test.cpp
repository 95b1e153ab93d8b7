#include "harness/campaign/statistics/worst_episodes.hpp"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "harness/campaign/store/store.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/campaign/campaign_fixture.hpp"

namespace qsmpc::harness {
namespace campaign_worst_episodes_test {

EpisodeRow row(const std::string& outcome, bool unsafe, double clearance, double cost,
               std::uint64_t seed = 0) {
  EpisodeRow row;
  row.seed = seed;
  row.outcome = outcome;
  row.unsafe = unsafe;
  row.min_clearance = clearance;
  row.cost = cost;
  return row;
}

TEST(WorstEpisodes, are_unsafe_or_faulted_ones_then_those_of_least_clearance_then_of_highest_cost) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<EpisodeRow> wanted = {
      row("fault", false, nan, 1.0, 1),   row("reached", true, -0.5, 1.0, 2),
      row("timeout", true, -0.1, 9.0, 3), row("fault", false, 2.0, 1.0, 4),
      row("collision", false, 0.0, 1, 5), row("reached", false, 0.3, 9.0, 6),
      row("reached", false, 0.3, 8.0, 7), row("reached", false, 0.3, 8.0, 8),
      row("timeout", false, 0.4, nan, 9)};
  std::vector<EpisodeRow> sorted(wanted.rbegin(), wanted.rend());
  std::ranges::sort(sorted, is_worse);
  for (std::size_t n = 0; n < wanted.size(); ++n) EXPECT_EQ(sorted[n].seed, wanted[n].seed) << n;
  EXPECT_FALSE(is_worse(wanted[0], wanted[0]));
}

TEST(WorstEpisodes, are_taken_from_all_variants_of_a_store_and_as_many_as_asked_for) {
  const testing::TemporaryFolder folder;
  const Campaign campaign = testing::quick_campaign(4);
  {
    Store store(folder.path(), stored_campaign(campaign, {}), stored_variants(campaign, {"", ""}),
                campaign.seeds, false);
    const double clearances[2][4] = {{0.5, 0.1, 0.9, 0.7}, {0.2, 0.8, 0.05, 0.6}};
    for (int variant = 0; variant < 2; ++variant) {
      for (int n = 0; n < 4; ++n) {
        EpisodeRow own = row("reached", false, clearances[variant][n], 1.0, 5 + n);
        own.variant = variant;
        store.add(own, false);
      }
    }
  }
  const StoreReader store(folder.path());
  const std::vector<EpisodeRow> worst = worst_episodes(store, 3);
  ASSERT_EQ(worst.size(), 3U);
  EXPECT_EQ(worst[0].min_clearance, 0.05);
  EXPECT_EQ(worst[1].min_clearance, 0.1);
  EXPECT_EQ(worst[1].variant, 0);
  EXPECT_EQ(worst[2].min_clearance, 0.2);
  EXPECT_EQ(worst[2].variant, 1);
  EXPECT_EQ(worst_episodes(store, 100).size(), 8U);
  EXPECT_TRUE(worst_episodes(store, 0).empty());
}

}  // namespace campaign_worst_episodes_test
}  // namespace qsmpc::harness
