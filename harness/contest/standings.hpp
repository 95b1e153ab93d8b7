// What a contest's drives say of each controller: in each cell, and over all of them.
//
// Drives of one seed share their random numbers, in all cells. What is said of a cell takes one
// drive of each seed, so that they are independent; what is said over all cells takes the seeds,
// and not the drives, for independent.
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

/// A p-value below it, or an interval of 99 % without 0, is called a difference.
inline constexpr double kContestLevel = 0.01;
/// Of fewer pairs no difference in cost is called one: a bootstrap of few is too sure of itself.
inline constexpr std::int64_t kFewestPairs = 20;

/// Who is ahead, in the controller's eyes.
enum class MatchResult { kWin, kTie, kLoss };

/// "win", "tie" or "loss".
[[nodiscard]] const char* match_result_name(MatchResult result);

/// By how much a controller's share of drives differs from the reference's on the same seeds.
struct ShareDifference {
  std::int64_t pairs = 0;   ///< of drives
  std::int64_t higher = 0;  ///< seeds on which the controller has more of them
  std::int64_t lower = 0;
  double mean = std::numeric_limits<double>::quiet_NaN();
  RateInterval interval{};  ///< 99 %, by a bootstrap over the seeds
  double p_value = 1.0;     ///< sign_test_p_value of higher and lower
};

/// The cost against the reference's, of the pairs in which both reached the target: other drives
/// were not charged for the same way.
struct CostDifference {
  std::int64_t pairs = 0;
  double mean = std::numeric_limits<double>::quiet_NaN();
  RateInterval interval{};  ///< 99 %
  /// The controller's mean by the reference's, each cell alone, and the mean over the cells that
  /// have pairs.
  double ratio = std::numeric_limits<double>::quiet_NaN();
  RateInterval ratio_interval{};  ///< 99 %
};

/// A controller less the reference.
struct Versus {
  ShareDifference reached{};
  ShareDifference unsafe{};
  CostDifference cost{};

  [[nodiscard]] MatchResult arrival() const;  ///< more drives that reached are better
  [[nodiscard]] MatchResult safety() const;   ///< fewer unsafe ones are
  [[nodiscard]] MatchResult economy() const;  ///< a lower cost is, by the ratio
};

struct ContestTimes {
  std::int64_t periods = 0;
  std::int64_t late = 0;  ///< that took longer than a period
  Distribution ocp_ms{};  ///< of planning and certifying; 0 without a period
};

struct Standing {
  std::int64_t drives = 0;
  EpisodeRate reached{};  ///< safely
  EpisodeRate collision{};
  EpisodeRate left_bounds{};
  EpisodeRate timeout{};
  EpisodeRate fault{};
  EpisodeRate unsafe{};            ///< the true state entered the unsafe set
  DriveMean believed{};            ///< of the sums along a drive of what the controller believed
  DriveMean certified{};           ///< of the sums of the certificates of the next step
  std::string no_bound{};          ///< why certificates are none; empty where they are bounds
  DriveMean cost{};                ///< of the drives that reached the target; of one cell only
  ContestTimes times{};            ///< of the drives that were timed
  std::optional<Versus> versus{};  ///< nothing for the reference itself
};

struct CellStandings {
  ContestCell cell{};
  std::string name{};
  std::vector<Standing> standings{};  ///< by controller
};

struct ContestResults {
  Contest contest{};
  std::string version{};  ///< of the program that drove
  TuningResult tuning{};
  std::int64_t asked = 0;  ///< drives
  std::int64_t done = 0;
  bool timed = false;  ///< whether the timed drives are done
  std::vector<CellStandings> cells{};
  std::vector<Standing> overall{};  ///< by controller
};

/// From the store of the contest's drives, and that of the timed ones; null where these are not
/// done. Reads every row some times. Throws what the stores throw.
[[nodiscard]] ContestResults contest_results(const Contest& contest, const TuningResult& tuning,
                                             const StoreReader& drives, const StoreReader* timed);

/// How many cells the controller wins, ties and loses against the reference.
struct CellCounts {
  int wins = 0;
  int ties = 0;
  int losses = 0;
};
[[nodiscard]] CellCounts cell_counts(const ContestResults& results, std::size_t controller,
                                     MatchResult (Versus::*by)() const);

}  // namespace qsmpc::harness
