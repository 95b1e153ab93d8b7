// What the store keeps of an episode.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/rare/rare_row.hpp"
#include "harness/trace/episode_view.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::harness {

/// A period that the plant came through.
struct PeriodRow {
  double certified = 0.0;  ///< that its end is unsafe, at most, as certified before it began
  double published = 0.0;  ///< the thesis's value for it; no bound
  bool unsafe = false;     ///< whether the true state at its end was unsafe
  double ocp_ms = 0.0;     ///< wall clock of planning and certifying

  friend bool operator==(const PeriodRow&, const PeriodRow&) = default;
};

/// A place on a map of the drive, see map_axes.
struct PathPoint {
  double x = 0.0;  ///< m
  double y = 0.0;  ///< m; of a system without a position in the plane, the unit of that state

  friend bool operator==(const PathPoint&, const PathPoint&) = default;
};

/// Of an episode's path in the store: enough to draw it.
inline constexpr std::size_t kMostPathPoints = 48;

/// Wall-clock values; everything else depends on scenario and seed alone.
struct EpisodeTiming {
  double finished_at = 0.0;  ///< s since 1970-01-01 00:00 UTC
  double wall_ms = 0.0;      ///< of the whole episode
  int deadline_misses = 0;   ///< periods whose planning took longer than the period

  friend bool operator==(const EpisodeTiming&, const EpisodeTiming&) = default;
};

struct EpisodeRow {
  std::int64_t variant = 0;  ///< index in the campaign
  std::uint64_t seed = 0;
  /// outcome_name of how it ended, never "interrupted"; of earlier versions also kLeftSafeSet.
  std::string outcome;
  std::string fault{};  ///< the simulator's words; empty without a fault
  int steps = 0;
  std::optional<double> time_to_target{};  ///< s; where it was reached
  bool unsafe = false;                     ///< the true state entered the unsafe set
  double min_clearance = 0.0;              ///< m
  double cost = 0.0;                       ///< Σ ½ |x − r|²_Q + |u|²_R
  double next_step_max = 0.0;              ///< of the certificates of the next step
  double next_step_sum = 0.0;
  double horizon_max = 0.0;  ///< of the plans' sums over their stages; not a number without plans
  double thesis_max = 0.0;   ///< of the published value; not a bound
  /// Of what the controller itself believed of the next step; nothing where it has no estimate, and
  /// in rows of versions that kept none.
  std::optional<double> believed_max{};
  std::optional<double> believed_sum{};
  double iterations_median = 0.0;  ///< cost-and-gradient evaluations of a plan
  int fallbacks = 0;
  /// Periods in which a limit of the risk is exceeded (RiskUse); nothing in rows of versions that
  /// did not count them.
  std::optional<int> risk_exceeded{};
  std::string trace{};    ///< folder of its trace, relative to the campaign's; empty: not kept
  std::string version{};  ///< of the program that drove it
  EpisodeTiming timing{};
  std::vector<PeriodRow> periods{};
  /// Where the true state was every so many periods and at its end, at most kMostPathPoints,
  /// without what is not finite; empty of a system without map_axes.
  std::vector<PathPoint> path{};
  /// What splitting that began with this episode says; where the campaign looks for rare outcomes.
  std::optional<RareRow> rare{};

  friend bool operator==(const EpisodeRow&, const EpisodeRow&) = default;
};

/// The row of an episode of variant `variant`; `trace` is empty and of the timing only
/// deadline_misses and ocp_ms are set.
[[nodiscard]] EpisodeRow episode_row(const EpisodeView& view, std::int64_t variant);

/// Where the trace of an episode is kept, within the campaign's folder: "episodes/VARIANT/SEED".
[[nodiscard]] std::string episode_folder(std::int64_t variant, std::uint64_t seed);

/// Whether the trace of such an episode is kept among the failures.
[[nodiscard]] bool is_failure(const EpisodeRow& row);

}  // namespace qsmpc::harness
