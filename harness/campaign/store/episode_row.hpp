// The data stored per episode.
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

/// A period that the plant completed.
struct PeriodRow {
  double certified = 0.0;  ///< certified bound of P(its end is unsafe), from before it began
  double published = 0.0;  ///< the thesis's value for this probability; not a bound
  bool unsafe = false;     ///< whether the true state at its end was unsafe
  double ocp_ms = 0.0;     ///< wall-clock time of planning and certifying

  friend bool operator==(const PeriodRow&, const PeriodRow&) = default;
};

/// A point on a map of the drive; see map_axes.
struct PathPoint {
  double x = 0.0;  ///< m
  double y = 0.0;  ///< m; for systems without a position in the plane, in the unit of that state

  friend bool operator==(const PathPoint&, const PathPoint&) = default;
};

/// Maximum number of points of a stored path: enough to plot it.
inline constexpr std::size_t kMostPathPoints = 48;

/// Wall-clock values; everything else depends only on scenario and seed.
struct EpisodeTiming {
  double finished_at = 0.0;  ///< s since 1970-01-01 00:00 UTC
  double wall_ms = 0.0;      ///< of the whole episode
  int deadline_misses = 0;   ///< periods whose planning took longer than the period

  friend bool operator==(const EpisodeTiming&, const EpisodeTiming&) = default;
};

struct EpisodeRow {
  std::int64_t variant = 0;  ///< index in the campaign
  std::uint64_t seed = 0;
  /// outcome_name of its outcome, never "interrupted"; in rows of earlier versions also
  /// kLeftSafeSet.
  std::string outcome;
  std::string fault{};  ///< the simulator's message; empty without a fault
  int steps = 0;
  std::optional<double> time_to_target{};  ///< s; only if the target was reached
  bool unsafe = false;                     ///< the true state entered the unsafe set
  double min_clearance = 0.0;              ///< m
  double cost = 0.0;                       ///< Σ ½ |x − r|²_Q + |u|²_R
  double next_step_max = 0.0;              ///< maximum over the next-step certificates
  double next_step_sum = 0.0;
  double horizon_max = 0.0;  ///< maximum over plans of their sum over stages; NaN without plans
  double thesis_max = 0.0;   ///< maximum of the published value; not a bound
  /// Of the controller's own next-step risk estimates; nothing if it has none, and in rows of
  /// versions that did not store them.
  std::optional<double> believed_max{};
  std::optional<double> believed_sum{};
  double iterations_median = 0.0;  ///< median over the plans of their cost-and-gradient evaluations
  int fallbacks = 0;
  /// Periods in which a risk limit is exceeded (RiskUse); nothing in rows of versions that did not
  /// count them.
  std::optional<int> risk_exceeded{};
  std::string trace{};    ///< folder of its trace, relative to the campaign's; empty if not kept
  std::string version{};  ///< of the program that drove it
  EpisodeTiming timing{};
  std::vector<PeriodRow> periods{};
  /// The true state on the map at regular intervals and at the end: at most kMostPathPoints,
  /// without non-finite points. Empty for systems without map_axes.
  std::vector<PathPoint> path{};
  /// The splitting run that began with this episode, if the campaign searches for rare outcomes.
  std::optional<RareRow> rare{};

  friend bool operator==(const EpisodeRow&, const EpisodeRow&) = default;
};

/// The row of an episode of variant `variant`; `trace` is empty, and only deadline_misses and
/// ocp_ms are set of the timings.
[[nodiscard]] EpisodeRow episode_row(const EpisodeView& view, std::int64_t variant);

/// The folder of an episode's trace, relative to the campaign's: "episodes/VARIANT/SEED".
[[nodiscard]] std::string episode_folder(std::int64_t variant, std::uint64_t seed);

/// Whether the episode is a failure, whose trace TraceKeeping::kFailures keeps.
[[nodiscard]] bool is_failure(const EpisodeRow& row);

/// Whether the drive is no failure and its next-step certificates sum to at most `limit`, a
/// probability; false where they are not numbers.
[[nodiscard]] bool is_certified_within(const EpisodeRow& row, double limit);

/// Whether the drive is no failure and each of its plans was certified at most `limit`, a
/// probability, at any stage; false without plans.
[[nodiscard]] bool is_planned_within(const EpisodeRow& row, double limit);

}  // namespace qsmpc::harness
