// The motion of an obstacle in the plane: along one of several intended ways, with Gaussian
// deviations from it, so that its future place is exactly a mixture of Gaussians
// (docs/theory/motion.md).
//
//   const ObstacleMotion walker = {.ways = {steady_way({1.2, 0.0})}, .speed_deviation = {0.2, 0}};
//   const Eigen::Vector2d offset = intended_offset(walker.ways[0], 2.5);
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#pragma GCC visibility push(default)

namespace qsmpc::models {

/// An intended place at a given time.
struct TimedPlace {
  double time = 0.0;                                ///< s
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< of the obstacle's centre, m
};

/// A way that an obstacle may intend to take.
struct IntendedWay {
  double probability = 1.0;
  /// In ascending order of time, with straight lines in between; the first at time 0, the place of
  /// the shape as it is specified.
  std::vector<TimedPlace> points = {TimedPlace{}};
  Eigen::Vector2d onward = Eigen::Vector2d::Zero();  ///< velocity after the last point, m/s
};

/// All pairs are (along, across) the way.
struct ObstacleMotion {
  /// At least one; the one taken is drawn at the start of a drive.
  std::vector<IntendedWay> ways = {IntendedWay{}};
  Eigen::Vector2d start_deviation = Eigen::Vector2d::Zero();  ///< from the way at time 0, m
  /// Standard deviation of the velocity from the way's, the same at all times, m/s, and the time
  /// constant `memory` of its correlation, s.
  Eigen::Vector2d speed_deviation = Eigen::Vector2d::Zero();
  double memory = 1.0;  ///< > 0
  /// Time constant in which 63 % of a deviation from the way is corrected, s; 0: never.
  Eigen::Vector2d returns_in = Eigen::Vector2d::Zero();
  /// Covariance rate of a random walk about the way, m²/s.
  Eigen::Vector2d covariance_rate = Eigen::Vector2d::Zero();
  double seen_deviation = 0.0;  ///< standard deviation of each coordinate of a measured place, m
  bool turns = false;           ///< whether the shape turns with the way
  /// The obstacle waits while the vehicle is nearer than this, m. Forecasts do not account for it.
  double yields = 0.0;

  /// Whether there is a single way and no deviation from it.
  [[nodiscard]] bool is_certain() const;
};

/// Straight from `from`, m, at `velocity`, m/s, without end.
[[nodiscard]] IntendedWay steady_way(const Eigen::Vector2d& velocity,
                                     const Eigen::Vector2d& from = Eigen::Vector2d::Zero());

/// Along the straight lines from place to place (2 x n, n ≥ 1, m) at `speed` > 0 m/s; it stops at
/// the last.
[[nodiscard]] IntendedWay way_along(const Eigen::Matrix2Xd& places, double speed);

/// Throws std::invalid_argument, stating what is expected, on missing ways, probabilities that are
/// not above 0 or do not add up to 1, several ways that begin apart or are measured exactly, times
/// that do not ascend, speeds above kFastestWay, negative deviations, times of return or distances
/// to wait at, a memory that is not above 0, and numbers that are not finite.
void check_obstacle_motion(const ObstacleMotion& motion);

/// Moving faster than this between places counts as a jump, m/s.
inline constexpr double kFastestWay = 100.0;

/// The offset of the way at a time ≥ 0 from its first place, m.
[[nodiscard]] Eigen::Vector2d intended_offset(const IntendedWay& way, double time);

/// The direction of the way at a time ≥ 0, rad in (−π, π]: that of the chord from half a second
/// before to half a second after, so that a turn at a corner takes one second. During a standstill,
/// the previous direction, or the first one if there is none; 0 if the way never moves.
[[nodiscard]] double way_direction(const IntendedWay& way, double time);

/// A deviation from the way in one direction, and its rate, over one period:
///   rate ← memory · rate + rate_noise · ξ,   deviation ← kept · deviation + period · rate +
///   walk_noise · η
/// with independent standard normal ξ and η.
struct DeviationStep {
  double memory = 0.0;
  double rate_noise = 0.0;
  double kept = 1.0;
  double period = 0.0;
  double walk_noise = 0.0;
};

/// `direction`: 0 along the way, 1 across. The standard deviation of the rate stays at
/// speed_deviation.
[[nodiscard]] DeviationStep deviation_step(const ObstacleMotion& motion, int direction,
                                           double time_step);

}  // namespace qsmpc::models

#pragma GCC visibility pop
