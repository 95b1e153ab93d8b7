#include "models/motion/obstacle_motion.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace qsmpc::models {
namespace {

// Half-width of the time window in which the direction is taken, s.
constexpr double kHalfTurn = 0.5;
// Probabilities may be rounded decimals.
constexpr double kProbabilitySlack = 1e-6;
// A smaller offset within that window counts as standing still, m.
constexpr double kStandsStill = 1e-9;

void require(bool holds, const char* expected) {
  if (!holds) throw std::invalid_argument(expected);
}

void check_way(const IntendedWay& way) {
  require(way.probability > 0.0 && way.probability <= 1.0 + kProbabilitySlack,
          "a probability above 0 and at most 1");
  require(!way.points.empty() && way.points.front().time == 0.0, "a way that begins at time 0");
  require(way.onward.allFinite() && way.onward.norm() <= kFastestWay,
          "a velocity of at most 100 m/s");
  for (std::size_t i = 0; i < way.points.size(); ++i) {
    require(std::isfinite(way.points[i].time) && way.points[i].place.allFinite(),
            "finite times and places");
    if (i == 0) continue;
    const double duration = way.points[i].time - way.points[i - 1].time;
    require(duration > 0.0, "ascending times, the first above 0");
    require((way.points[i].place - way.points[i - 1].place).norm() <= kFastestWay * duration,
            "places reached at 100 m/s at most, because an obstacle must not jump");
  }
}

bool is_deviation(const Eigen::Vector2d& pair) {
  return (pair.array() >= 0.0).all() && pair.allFinite();
}

}  // namespace

bool ObstacleMotion::is_certain() const {
  return ways.size() == 1 && start_deviation.isZero(0.0) && speed_deviation.isZero(0.0) &&
         covariance_rate.isZero(0.0);
}

IntendedWay steady_way(const Eigen::Vector2d& velocity, const Eigen::Vector2d& from) {
  return {.points = {{.place = from}}, .onward = velocity};
}

IntendedWay way_along(const Eigen::Matrix2Xd& places, double speed) {
  if (!(speed > 0.0)) throw std::invalid_argument("a speed above 0");
  IntendedWay way{.points = {{.place = places.col(0)}}};
  for (const auto& place : places.colwise()) {
    const TimedPlace& last = way.points.back();
    const double length = (place - last.place).norm();
    if (length == 0.0) continue;
    way.points.push_back({.time = last.time + length / speed, .place = place});
  }
  return way;
}

void check_obstacle_motion(const ObstacleMotion& motion) {
  require(!motion.ways.empty(), "at least one way");
  double sum = 0.0;
  for (const IntendedWay& way : motion.ways) {
    check_way(way);
    require(way.points.front().place == motion.ways.front().points.front().place,
            "ways that begin at the same place");
    sum += way.probability;
  }
  require(std::abs(sum - 1.0) <= kProbabilitySlack, "probabilities that add up to 1");
  require(motion.ways.size() == 1 || motion.seen_deviation > 0.0,
          "a seen_deviation above 0 where there are several ways");
  require(is_deviation(motion.start_deviation) && is_deviation(motion.speed_deviation) &&
              is_deviation(motion.covariance_rate),
          "deviations and rates of 0 or above, along and across");
  require(motion.memory > 0.0 && std::isfinite(motion.memory), "a memory above 0");
  require(is_deviation(motion.returns_in), "return times of 0 or above");
  require(motion.seen_deviation >= 0.0 && std::isfinite(motion.seen_deviation),
          "a seen_deviation of 0 or above");
  require(motion.yields >= 0.0 && std::isfinite(motion.yields), "a waiting distance of 0 or above");
}

Eigen::Vector2d intended_offset(const IntendedWay& way, double time) {
  const auto& points = way.points;
  const auto after =
      std::upper_bound(points.begin(), points.end(), time,
                       [](double at, const TimedPlace& point) { return at < point.time; });
  const Eigen::Vector2d& first = points.front().place;
  if (after == points.begin()) return Eigen::Vector2d::Zero();
  const TimedPlace& from = *(after - 1);
  const Eigen::Vector2d covered = from.place - first;
  if (after == points.end()) return covered + (time - from.time) * way.onward;
  const double share = (time - from.time) / (after->time - from.time);
  return covered + share * (after->place - from.place);
}

double way_direction(const IntendedWay& way, double time) {
  const auto chord = [&](double at) -> Eigen::Vector2d {
    return intended_offset(way, at + kHalfTurn) -
           intended_offset(way, std::max(0.0, at - kHalfTurn));
  };
  Eigen::Vector2d line = chord(time);
  // During a standstill, the previous direction, or else the first one to come.
  for (auto point = way.points.rbegin(); line.norm() < kStandsStill && point != way.points.rend();
       ++point) {
    if (point->time < time) line = chord(point->time);
  }
  for (auto point = way.points.begin(); line.norm() < kStandsStill && point != way.points.end();
       ++point) {
    line = chord(point->time);
  }
  return line.norm() < kStandsStill ? 0.0 : std::atan2(line.y(), line.x());
}

DeviationStep deviation_step(const ObstacleMotion& motion, int direction, double time_step) {
  DeviationStep step{.memory = std::exp(-time_step / motion.memory), .period = time_step};
  step.rate_noise =
      motion.speed_deviation[direction] * std::sqrt(-std::expm1(-2.0 * time_step / motion.memory));
  const double returns_in = motion.returns_in[direction];
  step.kept = returns_in > 0.0 ? std::exp(-time_step / returns_in) : 1.0;
  step.walk_noise = std::sqrt(motion.covariance_rate[direction] * time_step);
  return step;
}

}  // namespace qsmpc::models
