// Combines the splitting runs of a variant: the probability of an unsafe drive with its limits, the
// effort, and what was certified.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "harness/campaign/rare/rare_row.hpp"
#include "harness/statistics/binomial_interval.hpp"

namespace qsmpc::harness {

class StoreReader;

/// The estimate of one run.
struct RareEstimate {
  std::uint64_t seed = 0;
  double probability = 0.0;
  std::vector<RareDrive> found{};
};

/// The origin of the limits of the probability.
enum class RareLimits {
  kEstimates,  ///< skewed_mean_interval of the runs' estimates
  kPlain,  ///< Clopper–Pearson limits of the first drives: fewer than two runs found an unsafe
           ///< drive, or no run had to split
};

struct RareStatistics {
  std::vector<RareEstimate> runs{};
  int particles = 0;
  std::int64_t drives = 0;
  std::int64_t periods = 0;      ///< total driven, repeated ones included
  std::int64_t extinct = 0;      ///< runs that ended without an estimate above 0
  std::int64_t below_floor = 0;  ///< runs that ended at the floor
  // The first drives of all runs, a plain Monte Carlo sample.
  std::int64_t plain_drives = 0;
  std::int64_t plain_unsafe = 0;
  std::int64_t plain_periods = 0;
  std::int64_t plain_faults = 0;

  /// Probability that a drive is unsafe at some control instant: the mean of the runs' estimates,
  /// which is unbiased.
  double probability = 0.0;
  double standard_error = std::numeric_limits<double>::quiet_NaN();
  RateInterval interval{};  ///< 99 %
  RareLimits limits = RareLimits::kEstimates;
  double collision = 0.0;    ///< the part in which an obstacle is entered first
  double left_bounds = 0.0;  ///< the other part
  /// The number of plain drives whose share of unsafe ones would have the same standard error, and
  /// the periods that these take; NaN if the standard error is 0 or unknown.
  double worth_drives = std::numeric_limits<double>::quiet_NaN();
  double worth_periods = std::numeric_limits<double>::quiet_NaN();

  /// Mean of the sum of a drive's next-step certificates until it is unsafe, estimated like the
  /// probability, with 99 % limits. It bounds the probability if the certificates are bounds. NaN
  /// if drives were not certified.
  double certified = std::numeric_limits<double>::quiet_NaN();
  RateInterval certified_interval{.lower = kNotANumber, .upper = kNotANumber};

  /// Mean number of periods of a plain drive, until it was unsafe.
  [[nodiscard]] double periods_per_drive() const;
  /// The gain over plain Monte Carlo: worth_periods / periods.
  [[nodiscard]] double gain() const;
  /// Whether significantly more drives are unsafe than certified: the lower limit of the
  /// probability is above the upper limit of the certified mean.
  [[nodiscard]] bool exceeds_certified() const;
};

/// Combines the runs of `seeds`. Throws std::invalid_argument if there is no run, or not one seed
/// for each.
[[nodiscard]] RareStatistics rare_statistics(const std::vector<std::uint64_t>& seeds,
                                             const std::vector<RareRow>& rows);

/// The statistics of a variant in the store; nothing if none of its episodes has a splitting run.
[[nodiscard]] std::optional<RareStatistics> rare_statistics(const StoreReader& store,
                                                            std::int64_t variant);

}  // namespace qsmpc::harness
