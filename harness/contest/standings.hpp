// The statistics of each controller in a contest, per cell and over all cells.
//
// Drives with the same seed share their random numbers in all cells. Within a cell there is one
// drive per seed, so its drives are independent; statistics over all cells treat the seeds, not the
// drives, as independent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/statistics/tradeoff.hpp"
#include "harness/campaign/statistics/variant_statistics.hpp"
#include "harness/campaign/store/store_reader.hpp"
#include "harness/contest/contest.hpp"
#include "harness/contest/tuning.hpp"
#include "harness/statistics/binomial_interval.hpp"
#include "harness/statistics/quantiles.hpp"

namespace qsmpc::harness {

/// A p-value below this, or a 99 % interval without 0, counts as a difference.
inline constexpr double kContestLevel = 0.01;
/// With fewer pairs no cost difference is reported: bootstrap intervals of small samples are too
/// narrow.
inline constexpr std::int64_t kFewestPairs = 20;

/// The result of a comparison with the reference, from the controller's point of view.
enum class MatchResult { kWin, kTie, kLoss };

/// "win", "tie" or "loss".
[[nodiscard]] const char* match_result_name(MatchResult result);

/// The difference of a controller's share of drives from the reference's on the same seeds.
struct ShareDifference {
  std::int64_t pairs = 0;   ///< pairs of drives
  std::int64_t higher = 0;  ///< seeds on which the controller has more such drives
  std::int64_t lower = 0;
  double mean = std::numeric_limits<double>::quiet_NaN();
  RateInterval interval{};  ///< 99 %, by a bootstrap over the seeds
  double p_value = 1.0;     ///< sign_test_p_value of higher and lower
};

/// The cost relative to the reference's, over the pairs in which both reached the target: the costs
/// of other drives do not cover the same path.
struct CostDifference {
  std::int64_t pairs = 0;
  double mean = std::numeric_limits<double>::quiet_NaN();
  RateInterval interval{};  ///< 99 %
  /// The ratio of the controller's mean to the reference's in each cell, averaged over the cells
  /// that have pairs.
  double ratio = std::numeric_limits<double>::quiet_NaN();
  RateInterval ratio_interval{};  ///< 99 %
};

/// A controller minus the reference.
struct Versus {
  ShareDifference reached{};
  ShareDifference unsafe{};
  CostDifference cost{};

  [[nodiscard]] MatchResult arrival() const;  ///< more drives that reach the target are better
  [[nodiscard]] MatchResult safety() const;   ///< fewer unsafe drives are better
  [[nodiscard]] MatchResult economy() const;  ///< a lower cost is better, by the ratio
};

struct ContestTimes {
  std::int64_t periods = 0;
  std::int64_t late = 0;  ///< periods whose planning took longer than the period
  Distribution ocp_ms{};  ///< planning and certifying; all 0 without a period
};

struct Standing {
  std::int64_t drives = 0;
  EpisodeRate reached{};  ///< without having been unsafe
  EpisodeRate collision{};
  EpisodeRate left_bounds{};
  EpisodeRate timeout{};
  EpisodeRate fault{};
  EpisodeRate unsafe{};  ///< the true state entered the unsafe set
  /// Reached, with next-step certificates that sum to at most Contest::risk_limit; none without
  /// one. Where certificates are bounds, a drive becomes unsafe before their sum exceeds a limit
  /// with at most the limit's probability (docs/contest.md, "What is measured").
  std::optional<EpisodeRate> kept{};
  /// Reached, with every plan certified at most Contest::risk_limit at any of its stages before it
  /// was driven; none without a limit.
  std::optional<EpisodeRate> promised{};
  DriveMean believed{};            ///< sum along a drive of the risk the controller estimated
  DriveMean certified{};           ///< sum along a drive of the next-step certificates
  std::string no_bound{};          ///< why its certificates are not bounds; empty if they are
  DriveMean cost{};                ///< of the drives that reached the target; within one cell only
  ContestTimes times{};            ///< of the timed drives
  std::optional<Versus> versus{};  ///< none for the reference itself
};

struct CellStandings {
  ContestCell cell{};
  std::string name{};
  std::vector<Standing> standings{};  ///< by controller
};

struct ContestResults {
  Contest contest{};
  std::string version{};  ///< of the program that ran the drives
  TuningResult tuning{};
  std::int64_t asked = 0;  ///< number of drives
  std::int64_t done = 0;
  bool timed = false;  ///< whether the timed drives are done
  std::vector<CellStandings> cells{};
  std::vector<Standing> overall{};  ///< by controller
};

/// From the store of the contest's drives and that of the timed ones; `timed` is null if these are
/// not done. Reads every row several times. Throws what the stores throw.
[[nodiscard]] ContestResults contest_results(const Contest& contest, const TuningResult& tuning,
                                             const StoreReader& drives, const StoreReader* timed);

/// Number of cells in which the controller wins, ties and loses against the reference.
struct CellCounts {
  int wins = 0;
  int ties = 0;
  int losses = 0;
};
[[nodiscard]] CellCounts cell_counts(const ContestResults& results, std::size_t controller,
                                     MatchResult (Versus::*by)() const);

}  // namespace qsmpc::harness
