// What the runs of splitting of a variant say together: how probable an unsafe drive is, within
// which limits, what it took, and what was certified.
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

/// How the limits of the probability come about.
enum class RareLimits {
  kEstimates,  ///< skewed_mean_interval of the runs' estimates
  kPlain,      ///< Clopper and Pearson's of the first drives: too few runs found anything, or none
               ///< had to split
};

struct RareStatistics {
  std::vector<RareEstimate> runs{};
  int particles = 0;
  std::int64_t drives = 0;
  std::int64_t periods = 0;      ///< driven in all, what was driven again included
  std::int64_t extinct = 0;      ///< runs that ended without an estimate above 0
  std::int64_t below_floor = 0;  ///< runs that ended at the floor
  // The first drives of all runs, which are plain ones.
  std::int64_t plain_drives = 0;
  std::int64_t plain_unsafe = 0;
  std::int64_t plain_periods = 0;
  std::int64_t plain_faults = 0;

  /// That a drive is unsafe at some control instant: the mean of the runs' estimates, which is
  /// unbiased.
  double probability = 0.0;
  double standard_error = std::numeric_limits<double>::quiet_NaN();
  RateInterval interval{};  ///< 99 %
  RareLimits limits = RareLimits::kEstimates;
  double collision = 0.0;    ///< the part of it that enters an obstacle first
  double left_bounds = 0.0;  ///< the other part
  /// Plain drives whose share of unsafe ones has the same standard error, and the periods that
  /// these take; not numbers where it is 0 or not known.
  double worth_drives = std::numeric_limits<double>::quiet_NaN();
  double worth_periods = std::numeric_limits<double>::quiet_NaN();

  /// Mean of the sum of a drive's next-step certificates until it is unsafe, which bounds the
  /// probability where they are bounds: estimated as that is, with 99 % limits. Not numbers where
  /// drives were not certified.
  double certified = std::numeric_limits<double>::quiet_NaN();
  RateInterval certified_interval{.lower = kNotANumber, .upper = kNotANumber};

  /// Periods of a plain drive, until it was unsafe.
  [[nodiscard]] double periods_per_drive() const;
  /// worth_periods over periods.
  [[nodiscard]] double gain() const;
  /// Whether more drives are unsafe than is certified, beyond what chance explains: the limits of
  /// the one are above those of the other.
  [[nodiscard]] bool exceeds_certified() const;
};

/// Throws std::invalid_argument of no run.
[[nodiscard]] RareStatistics rare_statistics(const std::vector<std::uint64_t>& seeds,
                                             const std::vector<RareRow>& rows);

/// Of a variant in the store; nothing where no episode of it says anything of rare outcomes.
[[nodiscard]] std::optional<RareStatistics> rare_statistics(const StoreReader& store,
                                                            std::int64_t variant);

}  // namespace qsmpc::harness
