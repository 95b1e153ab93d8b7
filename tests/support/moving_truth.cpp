#include "tests/support/moving_truth.hpp"

#include <cmath>
#include <utility>

namespace qsmpc::testing {
namespace {

Eigen::Vector2d place_on(const models::IntendedWay& way, double time) {
  const auto& points = way.points;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (time > points[i].time) continue;
    const double share = (time - points[i - 1].time) / (points[i].time - points[i - 1].time);
    return (1.0 - share) * points[i - 1].place + share * points[i].place;
  }
  return points.back().place + (time - points.back().time) * way.onward;
}

/// For a way that never stands still.
double heading_on(const models::IntendedWay& way, double time) {
  const Eigen::Vector2d chord =
      place_on(way, time + 0.5) - place_on(way, time < 0.5 ? 0.0 : time - 0.5);
  return std::atan2(chord.y(), chord.x());
}

}  // namespace

MovingTruth::MovingTruth(models::ObstacleMotion motion, double time_step, int runs,
                         std::mt19937_64& generator)
    : motion_(std::move(motion)), time_step_(time_step), runs_(static_cast<std::size_t>(runs)) {
  std::vector<double> probabilities;
  for (const models::IntendedWay& way : motion_.ways) probabilities.push_back(way.probability);
  std::discrete_distribution<std::size_t> ways(probabilities.begin(), probabilities.end());
  for (Run& run : runs_) {
    run.way = ways(generator);
    for (int i = 0; i < 2; ++i) {
      run.off[i] = motion_.start_deviation[i] * normal_(generator);
      run.rate[i] = motion_.speed_deviation[i] * normal_(generator);
    }
  }
}

void MovingTruth::advance(std::mt19937_64& generator) {
  time_ += time_step_;
  const double remembered = std::exp(-time_step_ / motion_.memory);
  for (Run& run : runs_) {
    for (int i = 0; i < 2; ++i) {
      const double fresh = motion_.speed_deviation[i] * std::sqrt(1.0 - remembered * remembered);
      run.rate[i] = remembered * run.rate[i] + fresh * normal_(generator);
      if (motion_.returns_in[i] > 0.0) run.off[i] *= std::exp(-time_step_ / motion_.returns_in[i]);
      run.off[i] += time_step_ * run.rate[i] +
                    std::sqrt(time_step_ * motion_.covariance_rate[i]) * normal_(generator);
    }
  }
}

Eigen::Vector2d MovingTruth::offset(int i) const {
  const Run& run = runs_[static_cast<std::size_t>(i)];
  const models::IntendedWay& way = motion_.ways[run.way];
  const double heading = heading_on(way, time_);
  const Eigen::Vector2d along(std::cos(heading), std::sin(heading));
  return place_on(way, time_) - way.points.front().place + run.off[0] * along +
         run.off[1] * Eigen::Vector2d(-along.y(), along.x());
}

double MovingTruth::turn(int i) const {
  if (!motion_.turns) return 0.0;
  const models::IntendedWay& way = motion_.ways[runs_[static_cast<std::size_t>(i)].way];
  return heading_on(way, time_) - heading_on(way, 0.0);
}

}  // namespace qsmpc::testing
