// What one run of splitting over the drives of a variant found; the store keeps it beside the
// episode of its seed.
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

/// Of the drives that a run found, at most so many are kept, each once.
inline constexpr std::size_t kMostFound = 5;

struct RareRow {
  int particles = 0;
  double floor = 0.0;        ///< SplitSettings::floor
  double probability = 0.0;  ///< that a drive is unsafe at some control instant: an estimate
  double collision = 0.0;    ///< the part of it in which the first such instant is in an obstacle
  double left_bounds = 0.0;  ///< the other part
  std::int64_t levels = 0;   ///< SplitRun::levels
  std::int64_t drives = 0;   ///< driven, the first ones included
  std::int64_t periods = 0;  ///< driven in them
  bool extinct = false;      ///< SplitRun::extinct
  bool below_floor = false;  ///< SplitRun::below_floor
  // Of the first drives, which are `particles` plain ones, each until it was unsafe.
  std::int64_t plain_unsafe = 0;   ///< that were unsafe
  std::int64_t plain_periods = 0;  ///< driven in them
  std::int64_t plain_faults = 0;   ///< that faulted
  /// Mean over them of the sum of a drive's next-step certificates; not a number where one has
  /// none.
  double certified = kNotANumber;
  std::vector<RareDrive> found{};

  friend bool operator==(const RareRow&, const RareRow&) = default;
};

}  // namespace qsmpc::harness
