// Values at given ranks of a stream that is too long to be kept, exactly.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "harness/statistics/quantiles.hpp"

namespace qsmpc::harness {

/// A stream that can be read again: each call passes all of its values, none of them not a number,
/// to the function, in the same order.
using ValueStream = std::function<void(const std::function<void(double)>&)>;

/// Of how many values a stream is kept and sorted; longer ones are read several times.
inline constexpr std::int64_t kMostSortedValues = std::int64_t{1} << 24U;

/// The values at `ranks` (1 … count) of a stream of `count` values. The stream is read at most five
/// times; at most `most_kept` of its values are kept, and counts of a fixed size. Throws
/// std::invalid_argument on ranks that there are none of.
[[nodiscard]] std::vector<double> values_at_ranks(const ValueStream& each, std::int64_t count,
                                                  const std::vector<std::int64_t>& ranks,
                                                  std::int64_t most_kept = kMostSortedValues);

/// As SortedDistribution of the `count` values of a stream in ascending order. The mean of more
/// than `most_kept` of them is summed in the stream's own order.
[[nodiscard]] Distribution distribution_of(const ValueStream& each, std::int64_t count,
                                           std::int64_t most_kept = kMostSortedValues);

}  // namespace qsmpc::harness
