#include "controller/surroundings/motion_filter.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>

namespace qsmpc::controller {
namespace {

// Innovation variance, m², below which a measurement carries no information.
constexpr double kNoVariance = 1e-24;

}  // namespace

MotionFilter::MotionFilter(models::ObstacleMotion motion, double time_step)
    : motion_(std::move(motion)), time_step_(time_step) {
  models::check_obstacle_motion(motion_);
  if (!(time_step > 0.0)) throw std::invalid_argument("motion filter: a time step above 0");
  for (int i = 0; i < 2; ++i) steps_[i] = models::deviation_step(motion_, i, time_step);
  for (const models::IntendedWay& way : motion_.ways) {
    first_directions_.push_back(models::way_direction(way, 0.0));
  }
  begin();
}

void MotionFilter::begin() {
  period_ = 0;
  ways_.clear();
  for (const models::IntendedWay& way : motion_.ways) {
    Way& one = ways_.emplace_back(Way{.log_weight = std::log(way.probability)});
    for (int i = 0; i < 2; ++i) {
      one.deviations[i].covariance.diagonal() << std::pow(motion_.start_deviation[i], 2),
          std::pow(motion_.speed_deviation[i], 2);
    }
  }
}

// The measurement noise has the same deviation in every direction, so the filters of the two
// directions stay independent of each other.
void MotionFilter::see(const Eigen::Vector2d& offset) {
  if (!offset.allFinite()) throw std::invalid_argument("motion filter: a finite offset");
  const double noise = motion_.seen_deviation * motion_.seen_deviation;
  for (std::size_t n = 0; n < ways_.size(); ++n) {
    const models::IntendedWay& way = motion_.ways[n];
    const Eigen::Rotation2Dd to_way(-models::way_direction(way, time(0)));
    const Eigen::Vector2d seen = to_way * (offset - models::intended_offset(way, time(0)));
    for (int i = 0; i < 2; ++i) {
      Deviation& deviation = ways_[n].deviations[i];
      const double variance = deviation.covariance(0, 0) + noise;
      if (variance < kNoVariance) continue;
      const double surprise = seen[i] - deviation.mean[0];
      const Eigen::Vector2d gain = deviation.covariance.col(0) / variance;
      deviation.mean += gain * surprise;
      deviation.covariance -= gain * deviation.covariance.row(0).eval();
      deviation.covariance.diagonal() = deviation.covariance.diagonal().cwiseMax(0.0);
      deviation.covariance(1, 0) = deviation.covariance(0, 1);
      ways_[n].log_weight -= 0.5 * (std::log(variance) + surprise * surprise / variance);
    }
  }
}

void MotionFilter::advance() {
  for (Way& way : ways_) step(way);
  ++period_;
}

void MotionFilter::step(Way& way) const {
  for (int i = 0; i < 2; ++i) {
    const models::DeviationStep& by = steps_[i];
    Eigen::Matrix2d transition;
    transition << by.kept, by.period * by.memory, 0.0, by.memory;
    const Eigen::Vector2d pushed(by.period * by.rate_noise, by.rate_noise);
    Deviation& deviation = way.deviations[i];
    deviation.mean = transition * deviation.mean;
    deviation.covariance =
        transition * deviation.covariance * transition.transpose() + pushed * pushed.transpose();
    deviation.covariance(0, 0) += by.walk_noise * by.walk_noise;
  }
}

std::vector<double> MotionFilter::probabilities() const {
  double most = ways_.front().log_weight;
  for (const Way& way : ways_) most = std::max(most, way.log_weight);
  std::vector<double> weights;
  double sum = 0.0;
  for (const Way& way : ways_) sum += weights.emplace_back(std::exp(way.log_weight - most));
  for (double& weight : weights) weight /= sum;
  return weights;
}

ObstaclePlace MotionFilter::place(std::size_t index, const Way& way, double weight,
                                  int stage) const {
  const models::IntendedWay& intended = motion_.ways[index];
  const double direction = models::way_direction(intended, time(stage));
  const Eigen::Matrix2d frame = Eigen::Rotation2Dd(direction).toRotationMatrix();
  const Eigen::Vector2d deviation(way.deviations[0].mean[0], way.deviations[1].mean[0]);
  const Eigen::Vector2d variances(way.deviations[0].covariance(0, 0),
                                  way.deviations[1].covariance(0, 0));
  return {.weight = weight,
          .offset = models::intended_offset(intended, time(stage)) + frame * deviation,
          .turn = motion_.turns ? direction - first_directions_[index] : 0.0,
          .covariance = frame * variances.asDiagonal() * frame.transpose()};
}

PlacesByStage MotionFilter::forecast(int stages) const {
  const std::vector<double> weights = probabilities();
  PlacesByStage places(static_cast<std::size_t>(stages) + 1);
  for (std::size_t n = 0; n < ways_.size(); ++n) {
    Way way = ways_[n];
    for (int stage = 0; stage <= stages; ++stage) {
      if (stage > 0) step(way);
      places[static_cast<std::size_t>(stage)].push_back(place(n, way, weights[n], stage));
    }
  }
  return places;
}

}  // namespace qsmpc::controller
