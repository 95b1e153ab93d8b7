// Quantiles of a sorted stream, of which nothing is kept but the values at the ranks asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// The rank of the quantile of `share` by nearest rank: max(1, ⌈share count⌉).
[[nodiscard]] std::int64_t nearest_rank(double share, std::int64_t count);

/// Quantiles by nearest rank: the smallest value that at least the share q of the values do not
/// exceed, which is the one of rank max(1, ⌈q count⌉).
class SortedQuantiles {
 public:
  /// count: of the values that will be added; shares: ascending, in [0, 1].
  /// Throws std::invalid_argument for others.
  SortedQuantiles(std::int64_t count, const std::vector<double>& shares);

  /// `value`, `times` times; not below those before it.
  void add(double value, std::int64_t times = 1);

  /// By share; not a number where its rank has not come.
  [[nodiscard]] const std::vector<double>& values() const { return values_; }

 private:
  std::vector<std::int64_t> ranks_;  ///< from 1, ascending
  std::vector<double> values_;
  std::size_t next_ = 0;  ///< the first rank that has not come
  std::int64_t added_ = 0;
};

/// Quantiles by nearest rank, and the mean, of a sample.
struct Distribution {
  double median = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
  double max = 0.0;
  double mean = 0.0;
};

/// The shares of its quantiles: 0.5, 0.95, 0.99, 1.
[[nodiscard]] const std::vector<double>& distribution_shares();

/// The distribution of a sorted stream.
class SortedDistribution {
 public:
  /// count: of the values that will be added, ≥ 0.
  explicit SortedDistribution(std::int64_t count);

  void add(double value);
  /// Not a number where nothing was added.
  [[nodiscard]] Distribution result() const;

 private:
  SortedQuantiles quantiles_;
  std::int64_t added_ = 0;
  double sum_ = 0.0;
};

/// The distribution of `sample`, which may be in any order; all 0 where it is empty.
[[nodiscard]] Distribution distribution_or_zeros(std::vector<double> sample);

/// A running mean and its standard error (Welford: "Note on a method for calculating corrected sums
/// of squares and products", Technometrics 4, 1962).
class RunningMean {
 public:
  void add(double value);
  [[nodiscard]] std::int64_t count() const { return count_; }
  /// Not a number where nothing was added.
  [[nodiscard]] double mean() const;
  /// Not a number for fewer than two values.
  [[nodiscard]] double standard_error() const;

 private:
  std::int64_t count_ = 0;
  double mean_ = 0.0;
  double squares_ = 0.0;  ///< Σ (value − mean)²
};

}  // namespace qsmpc::harness

#pragma GCC visibility pop
