// How far a drive has come along the path of its scenario, and its laps; or which waypoints it has
// passed, and when.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "harness/scenario/scenario.hpp"
#include "harness/trace/trace.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Follows a vehicle along a path from period to period, so that it is never taken to be on
/// another stretch that is nearer by; or over waypoints, which are passed in turn. Without either
/// it knows nothing.
class TargetProgress {
 public:
  /// Refers to both.
  TargetProgress(const Scenario& scenario, const models::SystemDescription& system)
      : scenario_(scenario), system_(system) {}

  void reset() { now_.reset(); }
  /// The vehicle is now in `state` (state_dim).
  void advance(const Eigen::VectorXd& state);
  /// The arc length that it is at, m, counted on over laps, or the number of waypoints that it has
  /// passed; nothing without a path or waypoints.
  [[nodiscard]] const std::optional<double>& now() const { return now_; }

 private:
  const Scenario& scenario_;
  const models::SystemDescription& system_;
  std::optional<double> now_;
};

/// The arc length of the scenario's path at each of the true states at the control instants, m, or
/// the number of waypoints passed; empty without either.
[[nodiscard]] std::vector<double> progress_of(const Trace& trace);

/// The laps of a drive on a closed path.
struct Laps {
  int wanted = 0;
  std::vector<double> times{};  ///< of those that were finished, s
};

/// Waypoints of a drive.
struct WaypointTimes {
  int wanted = 0;
  std::vector<double> times{};  ///< at which they were passed, in order; the last: reached, s
};

/// Nothing where the scenario has no waypoints.
[[nodiscard]] std::optional<WaypointTimes> waypoint_times(const Trace& trace);

/// Nothing where the scenario has no closed path. A lap ends where the line across the path at
/// which the drive begins is crossed again; between control instants linearly.
[[nodiscard]] std::optional<Laps> laps_of(const Trace& trace);

}  // namespace qsmpc::harness
