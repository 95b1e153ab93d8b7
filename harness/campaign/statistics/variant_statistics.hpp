// The statistics of the episodes of one variant.
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

/// How the number of episodes was determined.
enum class Counted {
  kFixed,    ///< fixed beforehand
  kStopped,  ///< may depend on the results, as with Campaign::until
};

/// The share of episodes with an event and its 99 % limits: Clopper–Pearson, or a
/// confidence_sequence if the number of episodes is not fixed beforehand. The rate is NaN without
/// episodes.
struct EpisodeRate {
  std::int64_t events = 0;
  double rate = std::numeric_limits<double>::quiet_NaN();
  RateInterval interval{};
};

/// The rate of `events` in `trials`. Throws as clopper_pearson, except for trials = 0, where
/// nothing is known.
[[nodiscard]] EpisodeRate episode_rate(std::int64_t events, std::int64_t trials,
                                       Counted counted = Counted::kFixed);

/// The shares of the quantiles used to plot a distribution: 0, 1/40, …, 1.
[[nodiscard]] const std::vector<double>& curve_shares();

/// The distribution of a number over episodes.
struct Spread {
  std::int64_t count = 0;  ///< episodes that have it; mean and standard error are over these
  std::int64_t worst = 0;  ///< episodes without it that rank as worse than all others
  double mean = std::numeric_limits<double>::quiet_NaN();
  double standard_error = std::numeric_limits<double>::quiet_NaN();
  /// The quantiles of `count + worst` episodes at spread_shares; infinite at the worst ones, NaN
  /// without episodes.
  std::vector<double> quantiles = std::vector<double>(7, std::numeric_limits<double>::quiet_NaN());
  std::vector<double> curve{};  ///< the quantiles at curve_shares
};

/// The path of an episode on a map.
struct DrivenPath {
  std::string outcome;
  std::vector<PathPoint> points;
};

/// Maximum number of paths of a variant on its map; failures take precedence.
inline constexpr std::int64_t kMostDrawnPaths = 200;

/// 0, 0.05, 0.25, 0.5, 0.75, 0.95, 1, and their names: "min", "p5", "p25", "median", …
[[nodiscard]] const std::vector<double>& spread_shares();
[[nodiscard]] const std::vector<std::string>& spread_names();

/// How episodes without the number rank.
enum class WorstIs { kHighest, kLowest, kNotCounted };

/// Computes a Spread from the numbers in any order and then a second time in ascending order.
class SpreadTally {
 public:
  explicit SpreadTally(WorstIs worst_is) : worst_is_(worst_is) {}

  void add(double value) { mean_.add(value); }
  void add_worst() { ++worst_; }
  /// To be called once, after all numbers were added: each_sorted(visit) calls visit with them in
  /// ascending order.
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
  std::string no_bound{};       ///< why its certificates are not bounds; empty if they are
  std::int64_t episodes = 0;    ///< episodes requested
  std::int64_t done = 0;
  std::map<std::string, std::int64_t> outcomes{};
  EpisodeRate reached{};
  EpisodeRate collision{};
  EpisodeRate left_bounds{};
  EpisodeRate timeout{};
  EpisodeRate fault{};
  EpisodeRate left_safe_set{};     ///< collision or left_bounds, of earlier versions
  EpisodeRate unsafe{};            ///< the true state entered the unsafe set
  std::int64_t risk_exceeded = 0;  ///< drives in which a risk limit is exceeded
  Spread cost{};                   ///< a faulted episode ranks as infinite
  Spread min_clearance{};          ///< m; a faulted episode ranks as −∞
  Spread time_to_target{};         ///< s; of the episodes that reached it only
  Distribution ocp_ms{};           ///< of all periods; NaN without periods
  std::int64_t deadline_misses = 0;
  std::int64_t periods = 0;
  std::int64_t unsafe_periods = 0;    ///< periods that ended in the unsafe set
  double certified_periods = 0.0;     ///< sum of the certified probabilities of the periods
  std::int64_t believed_drives = 0;   ///< drives in which the controller estimates its risk
  std::int64_t believed_periods = 0;  ///< periods of these drives
  double believed = 0.0;              ///< sum of its estimates for these periods
  double p_value = 1.0;               ///< exceedance_p_value of all periods
  std::vector<CalibrationBin> calibration{};
  std::vector<CalibrationBin> published{};  ///< the same for the thesis's value, not a bound
  std::vector<DrivenPath> paths{};          ///< at most kMostDrawnPaths, failures first
  std::optional<RareStatistics> rare{};     ///< if the campaign searches for rare outcomes

  /// Means over the periods; NaN without periods.
  [[nodiscard]] double unsafe_step_rate() const;
  [[nodiscard]] double certified_step_rate() const;
  /// Mean of the controller's own risk estimates; NaN if it has none.
  [[nodiscard]] double believed_step_rate() const;
};

/// An outcome as shown in tables and figures.
struct ListedOutcome {
  std::string name;   ///< as in `VariantStatistics::outcomes`
  std::string title;  ///< a few words
  std::string verb;   ///< what a drive with this outcome did: "52 collided"
  EpisodeRate VariantStatistics::*rate = nullptr;
};

/// The possible outcomes of drives of this version, in display order.
[[nodiscard]] const std::vector<ListedOutcome>& listed_outcomes();
/// The same, followed by those outcomes of earlier versions that occur in `variants`.
[[nodiscard]] std::vector<ListedOutcome> outcomes_of(
    const std::vector<VariantStatistics>& variants);

/// Streaming counts of a variant's episodes and periods, in constant memory.
class VariantTally {
 public:
  /// Adds an episode; by seed.
  void add(const EpisodeRow& row);
  /// Adds a period; `period` is its number in the episode, from 0.
  void add(std::int64_t period, const PeriodRow& row);

  [[nodiscard]] const SpreadTally& cost() const { return cost_; }
  [[nodiscard]] const SpreadTally& min_clearance() const { return min_clearance_; }
  [[nodiscard]] const SpreadTally& time_to_target() const { return time_to_target_; }
  [[nodiscard]] const CalibrationTally& calibration() const { return calibration_; }
  [[nodiscard]] const CalibrationTally& published() const { return published_; }

  /// All statistics except the names, `episodes`, the spreads and the distribution of ocp_ms.
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
