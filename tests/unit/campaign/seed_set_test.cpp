// Seeds and shards of a campaign.
#include <stdexcept>

#include <gtest/gtest.h>

#include "harness/campaign/campaign.hpp"

namespace qsmpc::harness {
namespace seed_set_test {

TEST(SeedTexts, read_back_as_the_same_seeds) {
  for (const SeedSet& seeds : {SeedSet{.first = 3, .count = 1}, SeedSet{.first = 0, .count = 1000},
                               SeedSet{.listed = {4}}, SeedSet{.listed = {9, 2, 5}}}) {
    const SeedSet again = seeds_from_text(seeds_text(seeds));
    ASSERT_EQ(again.size(), seeds.size());
    for (std::int64_t i = 0; i < seeds.size(); ++i) EXPECT_EQ(again.at(i), seeds.at(i));
  }
  for (const char* text : {"", "5 to 3", "a", "1, ", "1,2", "1 to "}) {
    EXPECT_THROW((void)seeds_from_text(text), std::invalid_argument) << text;
  }
}

TEST(Shards, divide_the_seeds_without_rest) {
  for (const std::int64_t count : {1, 2, 3, 7}) {
    for (const std::int64_t seeds : {1, 2, 6, 20}) {
      std::int64_t shares = 0;
      for (std::int64_t index = 1; index <= count; ++index) {
        const Shard shard{.index = index, .count = count};
        std::int64_t mine = 0;
        for (std::int64_t i = 0; i < seeds; ++i) mine += shard.has(i) ? 1 : 0;
        EXPECT_EQ(shard.share(seeds), mine);
        shares += mine;
      }
      EXPECT_EQ(shares, seeds);
    }
  }
}

}  // namespace seed_set_test
}  // namespace qsmpc::harness
