#include "harness/statistics/rank_selection.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/statistics/quantiles.hpp"

namespace qsmpc::harness {
namespace rank_selection_test {

using ::testing::NanSensitiveDoubleEq;
using ::testing::Pointwise;

/// Counts how often it is read.
struct CountedStream {
  std::vector<double> values;
  int readings = 0;

  ValueStream stream() {
    return [this](const std::function<void(double)>& visit) {
      ++readings;
      std::ranges::for_each(values, visit);
    };
  }
};

std::vector<double> mixed_values() {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> values{-std::numeric_limits<double>::infinity(), 0.0, 5e-324, -5e-324,
                             std::numeric_limits<double>::infinity()};
  for (int n = 0; n < 2000; ++n) values.push_back(normal(random));
  for (int n = 0; n < 500; ++n) values.push_back(1.25);
  return values;
}

TEST(RankSelection, finds_what_sorting_finds_however_little_it_keeps) {
  CountedStream source{.values = mixed_values()};
  std::vector<double> sorted = source.values;
  std::ranges::sort(sorted);
  const auto count = static_cast<std::int64_t>(sorted.size());
  std::vector<std::int64_t> ranks;
  for (std::int64_t rank = 1; rank <= count; rank += 7) ranks.push_back(rank);
  ranks.push_back(count);
  for (const std::int64_t kept : {0, 10, 600, 10'000}) {
    const std::vector<double> found = values_at_ranks(source.stream(), count, ranks, kept);
    for (std::size_t n = 0; n < ranks.size(); ++n) {
      EXPECT_EQ(found[n], sorted[static_cast<std::size_t>(ranks[n] - 1)]) << ranks[n];
    }
  }
}

TEST(RankSelection, reads_the_stream_at_most_five_times) {
  CountedStream source{.values = mixed_values()};
  (void)values_at_ranks(source.stream(), std::ssize(source.values), {1, 1300, 2505}, 0);
  EXPECT_LE(source.readings, 5);
  source.readings = 0;
  (void)values_at_ranks(source.stream(), std::ssize(source.values), {1300}, 1000);
  EXPECT_EQ(source.readings, 2);
}

TEST(RankSelection, refuses_ranks_out_of_range) {
  CountedStream source{.values = {1.0, 2.0}};
  EXPECT_THROW((void)values_at_ranks(source.stream(), 2, {0}), std::invalid_argument);
  EXPECT_THROW((void)values_at_ranks(source.stream(), 2, {3}), std::invalid_argument);
}

TEST(RankSelection, a_distribution_is_the_same_whether_its_values_are_kept_or_not) {
  CountedStream source{.values = mixed_values()};
  source.values.erase(source.values.begin());  // the mean is to be finite
  source.values.erase(source.values.begin() + 3);
  KeptValues all;
  KeptValues few(50);
  for (const double value : source.values) {
    all.add(value);
    few.add(value);
  }
  EXPECT_TRUE(all.has_all());
  EXPECT_FALSE(few.has_all());
  const Distribution kept = all.distribution(source.stream());
  const Distribution selected = few.distribution(source.stream());
  EXPECT_EQ(kept.median, selected.median);
  EXPECT_EQ(kept.p95, selected.p95);
  EXPECT_EQ(kept.p99, selected.p99);
  EXPECT_EQ(kept.max, selected.max);
  EXPECT_EQ(kept.mean, selected.mean);
}

TEST(KeptValues, of_any_number_have_the_distribution_of_the_sorted_ones) {
  for (std::int64_t count = 0; count <= 130; ++count) {
    KeptValues kept;
    std::vector<double> sorted;
    for (std::int64_t i = 0; i < count; ++i) {
      sorted.push_back(static_cast<double>(i * 37 % 41));  // some are equal
      kept.add(sorted.back());
    }
    std::ranges::sort(sorted);
    SortedDistribution expected(count);
    for (const double value : sorted) expected.add(value);
    const Distribution found = kept.distribution({});
    EXPECT_THAT((std::vector{found.median, found.p95, found.p99, found.max, found.mean}),
                Pointwise(NanSensitiveDoubleEq(),
                          std::vector{expected.result().median, expected.result().p95,
                                      expected.result().p99, expected.result().max,
                                      expected.result().mean}))
        << count << " values";
  }
}

}  // namespace rank_selection_test
}  // namespace qsmpc::harness
