// What the episodes of one variant say together.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/rare/rare_statistics.hpp"
#include "harness/campaign/statistics/calibration.hpp"
#include "harness/campaign/store/episode_row.hpp"
#include "harness/statistics/binomial_interval.hpp"
#include "harness/statistics/quantiles.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {

/// Why the number of episodes is what it is.
enum class Counted {
  kFixed,    ///< it was fixed beforehand
  kStopped,  ///< it may depend on what happened, as with Campaign::until
};

/// How many of the episodes, with 99 % limits: by Clopper and Pearson, or where their number is not
/// fixed beforehand of a confidence_sequence. Not a number of none.
struct EpisodeRate {
  std::int64_t events = 0;
  double rate = std::numeric_limits<double>::quiet_NaN();
  RateInterval interval{};
};

/// Throws as clopper_pearson, except where trials = 0: nothing is known then.
[[nodiscard]] EpisodeRate episode_rate(std::int64_t events, std::int64_t trials,
                                       Counted counted = Counted::kFixed);

/// Shares of the quantiles that a distribution is drawn by: 0, 1/40, … 1.
[[nodiscard]] const std::vector<double>& curve_shares();

/// A number of episodes.
struct Spread {
  std::int64_t count = 0;  ///< episodes that have one: what mean and standard error are of
  std::int64_t worst = 0;  ///< episodes that have none and rank as worse than all others
  double mean = std::numeric_limits<double>::quiet_NaN();
  double standard_error = std::numeric_limits<double>::quiet_NaN();
  /// Of `count + worst` episodes by spread_shares; infinite where the worst are, not a number
  /// where there is none.
  std::vector<double> quantiles = std::vector<double>(7, std::numeric_limits<double>::quiet_NaN());
  std::vector<double> curve{};  ///< the same by curve_shares
};

/// An episode as a map shows it.
struct DrivenPath {
  std::string outcome;
  std::vector<PathPoint> points;
};

/// Of a variant on its map; of more, those that failed come first.
inline constexpr std::int64_t kMostDrawnPaths = 200;

/// 0, 0.05, 0.25, 0.5, 0.75, 0.95, 1, and what these are called: "min", "p5", "p25", "median", …
[[nodiscard]] const std::vector<double>& spread_shares();
[[nodiscard]] const std::vector<std::string>& spread_names();

/// Where the episodes rank that have no number.
enum class WorstIs { kHighest, kLowest, kNotCounted };

/// A spread, from the numbers in any order and then once more ascending.
class SpreadTally {
 public:
  explicit SpreadTally(WorstIs worst_is) : worst_is_(worst_is) {}

  void add(double value) { mean_.add(value); }
  void add_worst() { ++worst_; }
  /// To be called once, after all of them: each_sorted(visit) calls visit with them ascending.
  template <class EachSorted>
  [[nodiscard]] Spread result(const EachSorted& each_sorted) const;

 private:
  WorstIs worst_is_;
  RunningMean mean_{};
  std::int64_t worst_ = 0;
};

struct VariantStatistics {
  std::int64_t id = 0;
  std::string name{};
  std::string scenario{};
  std::string settings{};
  std::string plant{};
  std::string scenario_text{};  ///< resolved, as YAML
  std::string no_bound{};       ///< why its certificates are no bounds; empty where they are
  std::int64_t episodes = 0;    ///< asked for
  std::int64_t done = 0;
  std::map<std::string, std::int64_t> outcomes{};
  EpisodeRate reached{};
  EpisodeRate collision{};
  EpisodeRate left_bounds{};
  EpisodeRate timeout{};
  EpisodeRate fault{};
  EpisodeRate left_safe_set{};     ///< collision or left_bounds, of earlier versions
  EpisodeRate unsafe{};            ///< the true state entered the unsafe set
  std::int64_t risk_exceeded = 0;  ///< drives in which a limit of the risk is exceeded
  Spread cost{};                   ///< a faulted episode ranks as infinite
  Spread min_clearance{};          ///< m; a faulted episode ranks as −∞
  Spread time_to_target{};         ///< s; of the episodes that reached it only
  Distribution ocp_ms{};           ///< of all periods; not numbers without one
  std::int64_t deadline_misses = 0;
  std::int64_t periods = 0;
  std::int64_t unsafe_periods = 0;    ///< that ended in the unsafe set
  double certified_periods = 0.0;     ///< sum of what was certified for them
  std::int64_t believed_drives = 0;   ///< in which the controller itself has an estimate
  std::int64_t believed_periods = 0;  ///< of these drives
  double believed = 0.0;              ///< sum of what it believed of them
  double p_value = 1.0;               ///< exceedance_p_value of all periods
  std::vector<CalibrationBin> calibration{};
  std::vector<CalibrationBin> published{};  ///< the same of the thesis's value, which is no bound
  std::vector<DrivenPath> paths{};          ///< at most kMostDrawnPaths, failures first
  std::optional<RareStatistics> rare{};     ///< where the campaign looks for rare outcomes

  /// Shares of the periods; not numbers without one.
  [[nodiscard]] double unsafe_step_rate() const;
  [[nodiscard]] double certified_step_rate() const;
  /// Mean of what the controller believed; not a number where it has no estimate.
  [[nodiscard]] double believed_step_rate() const;
};

/// An outcome as tables and figures show it.
struct ListedOutcome {
  std::string name;   ///< as in `VariantStatistics::outcomes`
  std::string title;  ///< a few words
  std::string verb;   ///< what a drive did that ended so: "52 collided"
  EpisodeRate VariantStatistics::*rate = nullptr;
};

/// Those that a drive of this version may end with, in their order.
[[nodiscard]] const std::vector<ListedOutcome>& listed_outcomes();
/// The same, and after them those of earlier versions that some of `variants` have.
[[nodiscard]] std::vector<ListedOutcome> outcomes_of(
    const std::vector<VariantStatistics>& variants);

/// What is counted while a variant's episodes and periods stream by. Memory does not grow.
class VariantTally {
 public:
  /// Episodes by seed.
  void add(const EpisodeRow& row);
  /// Their periods; `period` is the number in the episode, from 0.
  void add(std::int64_t period, const PeriodRow& row);

  [[nodiscard]] const SpreadTally& cost() const { return cost_; }
  [[nodiscard]] const SpreadTally& min_clearance() const { return min_clearance_; }
  [[nodiscard]] const SpreadTally& time_to_target() const { return time_to_target_; }
  [[nodiscard]] const CalibrationTally& calibration() const { return calibration_; }
  [[nodiscard]] const CalibrationTally& published() const { return published_; }

  /// All but the names, `episodes`, the spreads and the distribution of ocp_ms.
  [[nodiscard]] VariantStatistics result(Counted counted = Counted::kFixed) const;

 private:
  std::int64_t done_ = 0;
  std::int64_t unsafe_ = 0;
  std::int64_t risk_exceeded_ = 0;
  std::int64_t deadline_misses_ = 0;
  std::int64_t believed_drives_ = 0;
  std::int64_t believed_periods_ = 0;
  double believed_ = 0.0;
  std::map<std::string, std::int64_t> outcomes_{};
  SpreadTally cost_{WorstIs::kHighest};
  SpreadTally min_clearance_{WorstIs::kLowest};
  SpreadTally time_to_target_{WorstIs::kNotCounted};
  CalibrationTally calibration_{};
  CalibrationTally published_{};
};

template <class EachSorted>
Spread SpreadTally::result(const EachSorted& each_sorted) const {
  const std::int64_t ranked = worst_is_ == WorstIs::kNotCounted ? 0 : worst_;
  SortedQuantiles quantiles(mean_.count() + ranked, spread_shares());
  SortedQuantiles curve(mean_.count() + ranked, curve_shares());
  const auto add = [&](double value, std::int64_t times) {
    quantiles.add(value, times);
    curve.add(value, times);
  };
  if (worst_is_ == WorstIs::kLowest && ranked > 0) add(-kInfinity, ranked);
  each_sorted([&](double value) { add(value, 1); });
  if (worst_is_ == WorstIs::kHighest && ranked > 0) add(kInfinity, ranked);
  return {.count = mean_.count(),
          .worst = ranked,
          .mean = mean_.mean(),
          .standard_error = mean_.standard_error(),
          .quantiles = quantiles.values(),
          .curve = curve.values()};
}

}  // namespace qsmpc::harness
