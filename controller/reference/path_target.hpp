// A target that moves along a path: what is wanted of the states at every stage of a plan.
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

/// What a speed along a path may be, m/s and m/s².
struct SpeedLimits {
  double along = 2.0;      ///< acceleration and deceleration, > 0
  double across = 2.0;     ///< acceleration towards the inside of a bend, > 0
  double top = kInfinity;  ///< speed, > 0
};

/// A speed by arc length: the same everywhere, or given at places that are equally far apart,
/// linear in between.
class SpeedProfile {
 public:
  /// m/s, > 0.
  explicit SpeedProfile(double speed) : speeds_({speed}) {}
  /// As fast as the limits allow: across by the curvature, then along by a pass forwards and one
  /// backwards (Heilmeier et al. 2020: "Minimum curvature trajectory planning and control for an
  /// autonomous race car"). An open path begins and ends at the speed of its bends.
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

/// A path that is followed at a speed.
struct PathTarget {
  std::shared_ptr<const ArcPath> path;
  SpeedProfile speed{1.0};
  double time_step = 0.1;  ///< of a stage, s
  // Arc lengths, counted on over the rounds of a closed path, m.
  double begin = 0.0;  ///< where the drive begins
  double end = 0.0;    ///< where it has arrived
};

/// The arc length at which the path is nearest to `position`: near `last` where that is given, so
/// that another stretch of the path that is nearer by is not taken for it; else on the whole path,
/// or on the round about the drive's beginning.
[[nodiscard]] double progress_on(const PathTarget& target, const Eigen::Vector2d& position,
                                 std::optional<double> last);

/// Writes to `out` (state_dim x stages, sized by the caller) what is wanted of a vehicle that is
/// in `state` (state_dim) at arc length `progress`: in column 0 now, and in each next one a time
/// step later at the path's speed. Position, heading (without a jump, beginning within π of that of
/// `state`) and, by their names, `speed` or `longitudinal_speed`, `yaw_rate`, `velocity_x` and
/// `velocity_y` are those of the path; other states are 0.
void path_targets(const PathTarget& target, const models::SystemDescription& system,
                  const Eigen::Ref<const Eigen::VectorXd>& state, double progress,
                  Eigen::Ref<Eigen::MatrixXd> out);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
