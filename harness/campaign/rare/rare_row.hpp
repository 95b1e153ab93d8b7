// The result of one splitting run over the drives of a variant; the store keeps it with the episode
// of its seed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "harness/splitting/splitting.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {

/// A drive that became unsafe.
struct RareDrive {
  PathSeeds seeds{};
  std::string outcome{};     ///< "collision" or "left_bounds"
  std::int64_t periods = 0;  ///< until it was unsafe

  friend bool operator==(const RareDrive&, const RareDrive&) = default;
};

/// Maximum number of distinct unsafe drives kept per run.
inline constexpr std::size_t kMostFound = 5;

struct RareRow {
  int particles = 0;
  double floor = 0.0;        ///< SplitSettings::floor
  double probability = 0.0;  ///< estimate: a drive is unsafe at some control instant
  double collision = 0.0;    ///< the part in which the first such instant is in an obstacle
  double left_bounds = 0.0;  ///< the other part
  std::int64_t levels = 0;   ///< SplitRun::levels
  std::int64_t drives = 0;   ///< number driven, the first ones included
  std::int64_t periods = 0;  ///< periods driven in `drives`
  bool extinct = false;      ///< SplitRun::extinct
  bool below_floor = false;  ///< SplitRun::below_floor
  // The first drives, a plain Monte Carlo sample of `particles`, each until it was unsafe:
  std::int64_t plain_unsafe = 0;   ///< number of unsafe ones
  std::int64_t plain_periods = 0;  ///< periods driven in them
  std::int64_t plain_faults = 0;   ///< number that faulted
  /// Estimated mean of the sum of a drive's next-step certificates; NaN if a drive has none.
  double certified = kNotANumber;
  std::vector<RareDrive> found{};

  friend bool operator==(const RareRow&, const RareRow&) = default;
};

}  // namespace qsmpc::harness
