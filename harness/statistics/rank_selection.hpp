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
inline constexpr std::int64_t kMostSortedValues = std::int64_t{1} << 25U;

/// The values at `ranks` (1 … count) of a stream of `count` values. The stream is read at most five
/// times; at most `most_kept` of its values are kept, and counts of a fixed size. Throws
/// std::invalid_argument on ranks that there are none of.
[[nodiscard]] std::vector<double> values_at_ranks(const ValueStream& each, std::int64_t count,
                                                  const std::vector<std::int64_t>& ranks,
                                                  std::int64_t most_kept = kMostSortedValues);

/// The values of a stream, kept while they are few enough to be sorted.
class KeptValues {
 public:
  explicit KeptValues(std::int64_t most_kept = kMostSortedValues) : most_kept_(most_kept) {}

  /// A value that is a number.
  void add(double value);
  [[nodiscard]] bool has_all() const { return count_ <= most_kept_; }
  /// All of them ascending; has_all() holds.
  [[nodiscard]] const std::vector<double>& sorted();
  /// As SortedDistribution of all values. Where they are not kept, `each` is the same stream, which
  /// is read again, and the mean is summed in its order.
  [[nodiscard]] Distribution distribution(const ValueStream& each);

 private:
  std::int64_t most_kept_;
  std::int64_t count_ = 0;
  double sum_ = 0.0;
  std::vector<double> values_{};  ///< empty once they are too many
};

}  // namespace qsmpc::harness
