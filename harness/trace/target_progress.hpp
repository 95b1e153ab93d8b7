// A drive's progress along the path of its scenario, and its laps; or the waypoints that it has
// passed, and when.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "harness/scenario/scenario.hpp"
#include "harness/trace/trace.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Tracks a vehicle along a path from period to period, so that a nearer point on another stretch
/// of the path is never mistaken for its position; or over waypoints, which are passed in order.
/// Without a path or waypoints there is no progress.
class TargetProgress {
 public:
  /// Keeps references to both arguments.
  TargetProgress(const Scenario& scenario, const models::SystemDescription& system)
      : scenario_(scenario), system_(system) {}

  void reset() { now_.reset(); }
  /// The vehicle is now in `state` (state_dim).
  void advance(const Eigen::VectorXd& state);
  /// The vehicle's arc length, m, accumulated over laps, or the number of waypoints passed; nothing
  /// without a path or waypoints.
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
  std::vector<double> times{};  ///< of the completed laps, s
};

/// Waypoints of a drive.
struct WaypointTimes {
  int wanted = 0;
  std::vector<double> times{};  ///< at which they were passed (the last: reached), in order, s
};

/// Nothing if the scenario has no waypoints.
[[nodiscard]] std::optional<WaypointTimes> waypoint_times(const Trace& trace);

/// Nothing if the scenario has no closed path. A lap ends when the vehicle again crosses the line
/// across the path at the drive's start; times are interpolated linearly between control instants.
[[nodiscard]] std::optional<Laps> laps_of(const Trace& trace);

}  // namespace qsmpc::harness
