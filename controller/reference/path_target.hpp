// A target that moves along a path: the reference states at every stage of a plan.
//
//   const double progress = progress_on(target, position, last_progress);
//   path_targets(target, system, state, progress, targets);   // targets.col(k): of stage k
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "controller/reference/arc_path.hpp"
#include "models/constants.hpp"
#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// Limits on speed (m/s) and acceleration (m/s²) along a path.
struct SpeedLimits {
  double along = 2.0;      ///< acceleration and deceleration, > 0
  double across = 2.0;     ///< acceleration towards the inside of a bend, > 0
  double top = kInfinity;  ///< speed, > 0
};

/// A speed as a function of arc length: constant, or piecewise linear between equidistant places.
class SpeedProfile {
 public:
  /// m/s, > 0.
  explicit SpeedProfile(double speed) : speeds_({speed}) {}
  /// As fast as the limits allow: the lateral limit by the curvature, then the longitudinal one by
  /// a forward and a backward pass (Heilmeier et al. 2020: "Minimum curvature trajectory planning
  /// and control for an autonomous race car"). An open path does not start or stop at rest: at its
  /// ends, too, only these limits apply.
  SpeedProfile(const ArcPath& path, const SpeedLimits& limits);

  /// m/s. Beyond the ends of an open path, as at them.
  [[nodiscard]] double at(double along) const;
  /// The highest, m/s.
  [[nodiscard]] double top() const;

 private:
  std::vector<double> speeds_;
  double spacing_ = 1.0;  // m
  bool closed_ = false;
};

/// A path to follow at a speed.
struct PathTarget {
  std::shared_ptr<const ArcPath> path;
  SpeedProfile speed{1.0};
  double time_step = 0.1;  ///< of a stage, s
  // Arc lengths, accumulated over the laps of a closed path, m.
  double begin = 0.0;  ///< where the drive begins
  double end = 0.0;    ///< where it has arrived
};

/// The arc length at which the path is nearest to `position`: near `last` if given, so that another
/// stretch of the path that happens to be nearer is not mistaken for it; else on the whole path,
/// or, if it is closed, on the lap centred on the drive's beginning.
[[nodiscard]] double progress_on(const PathTarget& target, const Eigen::Vector2d& position,
                                 std::optional<double> last);

/// Writes to `out` (state_dim x stages, sized by the caller) the reference states of a vehicle in
/// `state` (state_dim) at arc length `progress`: column 0 for now, each further column one time
/// step later at the path's speed. Position, heading (without a jump, beginning within π of that of
/// `state`) and, by their names, `speed` or `longitudinal_speed`, `yaw_rate`, `velocity_x` and
/// `velocity_y` are those of the path; other states are 0.
void path_targets(const PathTarget& target, const models::SystemDescription& system,
                  const Eigen::Ref<const Eigen::VectorXd>& state, double progress,
                  Eigen::Ref<Eigen::MatrixXd> out);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
