// Quantiles of a sorted stream; only the values at the requested ranks are kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// The nearest rank of the `share` quantile of `count` values: max(1, ⌈share count⌉).
[[nodiscard]] std::int64_t nearest_rank(double share, std::int64_t count);

/// Nearest-rank quantiles: the q-quantile is the smallest value that at least a share q of the
/// values do not exceed, i.e. the one of rank max(1, ⌈q count⌉).
class SortedQuantiles {
 public:
  /// count: how many values will be added, ≥ 0; shares: ascending, in [0, 1]. Throws
  /// std::invalid_argument otherwise.
  SortedQuantiles(std::int64_t count, const std::vector<double>& shares);

  /// Adds `value` `times` times; values must be added in ascending order.
  void add(double value, std::int64_t times = 1);

  /// The quantile of each share; NaN where its rank has not been reached.
  [[nodiscard]] const std::vector<double>& values() const { return values_; }

 private:
  std::vector<std::int64_t> ranks_;  ///< 1-based, ascending
  std::vector<double> values_;
  std::size_t next_ = 0;  ///< index of the first rank not yet reached
  std::int64_t added_ = 0;
};

/// Nearest-rank quantiles and the mean of a sample.
struct Distribution {
  double median = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
  double max = 0.0;
  double mean = 0.0;
};

/// The shares of the quantiles of a Distribution: 0.5, 0.95, 0.99, 1.
[[nodiscard]] const std::vector<double>& distribution_shares();

/// The distribution of a sorted stream.
class SortedDistribution {
 public:
  /// count: how many values will be added, ≥ 0.
  explicit SortedDistribution(std::int64_t count);

  void add(double value);
  /// NaN if nothing was added.
  [[nodiscard]] Distribution result() const;

 private:
  SortedQuantiles quantiles_;
  std::int64_t added_ = 0;
  double sum_ = 0.0;
};

/// The distribution of `sample`, which may be in any order; all 0 if it is empty.
[[nodiscard]] Distribution distribution_or_zeros(std::vector<double> sample);

/// A running mean and its standard error (Welford: "Note on a method for calculating corrected sums
/// of squares and products", Technometrics 4, 1962).
class RunningMean {
 public:
  void add(double value);
  [[nodiscard]] std::int64_t count() const { return count_; }
  /// NaN if nothing was added.
  [[nodiscard]] double mean() const;
  /// NaN for fewer than two values.
  [[nodiscard]] double standard_error() const;

 private:
  std::int64_t count_ = 0;
  double mean_ = 0.0;
  double squares_ = 0.0;  ///< Σ (value − mean)²
};

}  // namespace qsmpc::harness

#pragma GCC visibility pop
