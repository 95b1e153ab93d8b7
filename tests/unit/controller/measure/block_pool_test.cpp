// Memory that is returned and reused.
#include "controller/measure/compression/block_pool.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace qsmpc::controller {
namespace block_pool_test {

TEST(BlockPool, blocks_are_apart_and_begin_a_cache_line) {
  std::mt19937_64 generator(5);
  std::uniform_int_distribution<std::size_t> sizes(1, 5000);
  BlockPool pool;
  for (int round = 0; round < 3; ++round) {
    std::vector<Block*> blocks;
    std::vector<std::size_t> counts;
    for (int n = 0; n < 500; ++n) {
      if (n % 3 == 2) {
        // The following must not touch the other blocks.
        pool.give_back(blocks.back());
        blocks.pop_back();
        counts.pop_back();
      }
      counts.push_back(sizes(generator));
      blocks.push_back(pool.take(counts.back()));
      double* const data = blocks.back()->data();
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(data) % 64, 0U);
      std::fill(data, data + counts.back(), static_cast<double>(blocks.size()));
    }
    for (std::size_t n = 0; n < blocks.size(); ++n) {
      const double* const data = blocks[n]->data();
      const auto own = static_cast<double>(n + 1);
      EXPECT_TRUE(std::all_of(data, data + counts[n], [&](double x) { return x == own; })) << n;
    }
    pool.reset();
  }
}

TEST(BlockPool, what_is_given_back_is_used_again_for_as_much_or_hardly_less) {
  BlockPool pool;
  for (const std::size_t count : {1U, 8U, 9U, 100U, 1000U, 12345U, 1000000U}) {
    Block* const block = pool.take(count);
    EXPECT_GE(8 * block->lines, count);
    EXPECT_LE(8 * block->lines, count + count / 8 + 8);
    const std::size_t least = block->lines > 16 ? 8 * block->lines - 8 * block->lines / 17 : count;
    pool.give_back(block);
    EXPECT_EQ(pool.take(least), block) << count;
    EXPECT_NE(pool.take(count), block) << count;
  }
}

}  // namespace block_pool_test
}  // namespace qsmpc::controller
