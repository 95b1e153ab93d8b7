#include "controller/surroundings/obstacle_forecast.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace qsmpc::controller {

std::span<const ObstaclePlace> ObstacleForecast::at(std::size_t obstacle,
                                                    Eigen::Index stage) const {
  const PlacesByStage& stages = places_[obstacle];
  return stages[std::min(static_cast<std::size_t>(stage), stages.size() - 1)];
}

const ObstaclePlace& ObstacleForecast::likeliest(std::size_t obstacle, Eigen::Index stage) const {
  const std::span<const ObstaclePlace> places = at(obstacle, stage);
  return *std::max_element(places.begin(), places.end(),
                           [](const auto& a, const auto& b) { return a.weight < b.weight; });
}

bool ObstacleForecast::is_certain(Eigen::Index stage) const {
  for (std::size_t obstacle = 0; obstacle < places_.size(); ++obstacle) {
    const std::span<const ObstaclePlace> places = at(obstacle, stage);
    if (places.size() != 1 || !places.front().covariance.isZero(0.0)) return false;
  }
  return true;
}

void ObstacleForecast::set(std::size_t obstacle, PlacesByStage places) {
  const auto is_empty = [](const auto& stage) { return stage.empty(); };
  if (places.empty() || std::any_of(places.begin(), places.end(), is_empty)) {
    throw std::invalid_argument("a forecast needs a place for each stage");
  }
  places_.at(obstacle) = std::move(places);
}

}  // namespace qsmpc::controller
