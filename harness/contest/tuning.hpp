// Chooses the candidate of each controller by the same criterion for all, on drives with seeds that
// the contest does not use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "harness/campaign/store/store_reader.hpp"
#include "harness/contest/contest.hpp"

namespace qsmpc::harness {

/// The results of a candidate's drives.
struct TriedCandidate {
  std::size_t candidate = 0;
  std::int64_t drives = 0;
  /// Drives that were unsafe or did not reach the target, or, in a contest with a risk limit, did
  /// not keep it (Standing::kept).
  std::int64_t failures = 0;
  /// The mean cost of the drives that reached the target, in each cell divided by the mean over all
  /// candidates of the controller, then averaged over the cells; NaN if no drive reached the
  /// target.
  double relative_cost = std::numeric_limits<double>::quiet_NaN();
};

/// By controller: the candidates tried (none if there was nothing to choose), and the choice.
struct TuningResult {
  std::vector<std::vector<TriedCandidate>> tried{};
  ContestChoice choice{};
};

/// The failures of the search in words: "unsafe or not arrived".
[[nodiscard]] std::string failure_words(const Contest& contest);
/// The criterion in words.
[[nodiscard]] std::string tuning_criterion(const Contest& contest);

/// The best of `tried` by the criterion, the first of equal ones. `tried` has at least one.
[[nodiscard]] std::size_t best_candidate(const std::vector<TriedCandidate>& tried);

/// The result without a search: the first candidate of each controller.
[[nodiscard]] TuningResult untuned(const Contest& contest);

/// The result of the search whose drives, all done, are in `search`. Throws what the store throws.
[[nodiscard]] TuningResult tuned(const Contest& contest, const StoreReader& search);

}  // namespace qsmpc::harness
