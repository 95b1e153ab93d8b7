// Which of its candidates each controller drives with: the same criterion for all, on drives of
// seeds that the contest does not have.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "harness/campaign/store/store_reader.hpp"
#include "harness/contest/contest.hpp"

namespace qsmpc::harness {

/// What became of a candidate's drives.
struct TriedCandidate {
  std::size_t candidate = 0;
  std::int64_t drives = 0;
  std::int64_t failures = 0;  ///< that were unsafe, or did not reach the target
  /// The mean cost of the drives that reached the target, in units of the mean over all candidates
  /// of the controller, each cell alone, then the mean over the cells; not a number where none did.
  double relative_cost = std::numeric_limits<double>::quiet_NaN();
};

/// Of all controllers, by controller: what was tried, none where there was nothing to choose.
struct TuningResult {
  std::vector<std::vector<TriedCandidate>> tried{};
  ContestChoice choice{};
};

/// What the criterion is, in words.
inline constexpr const char* kTuningCriterion =
    "fewest drives that were unsafe or did not reach the target, then the lowest mean cost of "
    "those "
    "that did, each scenario, plant and noise in units of the mean over the controller's "
    "candidates";

/// The best of `tried`, at least one: by the criterion, of equal ones the first.
[[nodiscard]] std::size_t best_candidate(const std::vector<TriedCandidate>& tried);

/// What nothing was tried for: the first candidate of each.
[[nodiscard]] TuningResult untuned(const Contest& contest);

/// From the store of the search's drives, all of which are done. Throws what the store throws.
[[nodiscard]] TuningResult tuned(const Contest& contest, const StoreReader& search);

}  // namespace qsmpc::harness
