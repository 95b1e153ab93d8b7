// Exact order statistics of a stream that is too long to be kept.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "harness/statistics/quantiles.hpp"

namespace qsmpc::harness {

/// A stream that can be read repeatedly: each call passes all of its values, none of them NaN, to
/// the function in the same order.
using ValueStream = std::function<void(const std::function<void(double)>&)>;

/// A stream of up to this many values is kept; longer ones are read several times.
inline constexpr std::int64_t kMostSortedValues = std::int64_t{1} << 25U;

/// The values at `ranks` (1 … count) of a stream of `count` values. The stream is read at most five
/// times; at most `most_kept` of its values are kept, besides counts of a fixed size. Throws
/// std::invalid_argument on ranks out of range.
[[nodiscard]] std::vector<double> values_at_ranks(const ValueStream& each, std::int64_t count,
                                                  const std::vector<std::int64_t>& ranks,
                                                  std::int64_t most_kept = kMostSortedValues);

/// The values of a stream, kept as long as they are few enough.
class KeptValues {
 public:
  explicit KeptValues(std::int64_t most_kept = kMostSortedValues) : most_kept_(most_kept) {}

  /// value: not NaN.
  void add(double value);
  [[nodiscard]] bool has_all() const { return count_ <= most_kept_; }
  /// All values, ascending. Precondition: has_all().
  [[nodiscard]] const std::vector<double>& sorted();
  /// The distribution of all values, as SortedDistribution has it, but with the mean summed in
  /// stream order. Where they are not kept, `each`, the same stream, is read again.
  [[nodiscard]] Distribution distribution(const ValueStream& each);

 private:
  std::vector<double> selected(const std::vector<std::int64_t>& ranks);

  std::int64_t most_kept_;
  std::int64_t count_ = 0;
  double sum_ = 0.0;
  std::vector<double> values_{};  ///< empty once there are too many
};

}  // namespace qsmpc::harness
