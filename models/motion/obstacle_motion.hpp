// How an obstacle of the plane moves: along one of several ways that it may intend, and off it by
// Gaussian disturbances, so that where it will be is a mixture of Gaussians exactly
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

/// Where something means to be at a time.
struct TimedPlace {
  double time = 0.0;                                ///< s
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< of its centre, m
};

/// One way that it may intend to go.
struct IntendedWay {
  double probability = 1.0;
  /// By ascending times, straight on between them; the first at time 0, which is where its shape
  /// is written.
  std::vector<TimedPlace> points = {TimedPlace{}};
  Eigen::Vector2d onward = Eigen::Vector2d::Zero();  ///< velocity after the last point, m/s
};

/// All pairs are (along, across) the way.
struct ObstacleMotion {
  /// At least one; which one it goes is drawn when a drive begins.
  std::vector<IntendedWay> ways = {IntendedWay{}};
  Eigen::Vector2d start_deviation = Eigen::Vector2d::Zero();  ///< from the way at time 0, m
  /// Of the velocity from the way's, once and for all times, m/s, and for how long it remembers
  /// what that was, s.
  Eigen::Vector2d speed_deviation = Eigen::Vector2d::Zero();
  double memory = 1.0;  ///< > 0
  /// Time in which 63 % of a deviation from the way is made good, s; 0: never.
  Eigen::Vector2d returns_in = Eigen::Vector2d::Zero();
  /// Of a random walk about the way, m²/s.
  Eigen::Vector2d covariance_rate = Eigen::Vector2d::Zero();
  double seen_deviation = 0.0;  ///< of each coordinate of a measurement of its place, m
  bool turns = false;           ///< whether it turns with its way
  /// It waits while the vehicle is nearer than this to it, m. No forecast knows that it does.
  double yields = 0.0;

  /// Whether it is where its only way says.
  [[nodiscard]] bool is_certain() const;
};

/// Straight on for ever at `velocity`, m/s, from `from`, m.
[[nodiscard]] IntendedWay steady_way(const Eigen::Vector2d& velocity,
                                     const Eigen::Vector2d& from = Eigen::Vector2d::Zero());

/// Along the straight lines from place to place (2 x n, n ≥ 1, m) at `speed` > 0 m/s; it stops at
/// the last.
[[nodiscard]] IntendedWay way_along(const Eigen::Matrix2Xd& places, double speed);

/// Throws std::invalid_argument, saying what is expected, on no ways, probabilities that are not
/// above 0 or do not add up to 1, several ways that are seen exactly or begin apart, times that do
/// not ascend, places that are reached at more than kFastestWay only, negative deviations and times
/// of return, a memory that is not above 0, and numbers that are not finite.
void check_obstacle_motion(const ObstacleMotion& motion);

/// What moves faster from one place to the next jumps, m/s.
inline constexpr double kFastestWay = 100.0;

/// How far the way is at a time ≥ 0 from its first place.
[[nodiscard]] Eigen::Vector2d intended_offset(const IntendedWay& way, double time);

/// The direction of the way at a time ≥ 0, rad in (−π, π]: of the line between where it is half a
/// second before and after, so that it turns in a second at a corner. Where it stands still, the
/// direction before; 0 where it never moves.
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

/// `direction`: 0 along the way, 1 across. The rate's deviation stays speed_deviation.
[[nodiscard]] DeviationStep deviation_step(const ObstacleMotion& motion, int direction,
                                           double time_step);

}  // namespace qsmpc::models

#pragma GCC visibility pop
