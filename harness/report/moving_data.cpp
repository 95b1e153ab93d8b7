#include "harness/report/moving_data.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/report/packed_numbers.hpp"
#include "harness/trace/seen_forecasts.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMostStages = 6;                 // per forecast
constexpr std::size_t kNumbers = 5;            // per place: x, y, xx, xy, yy
constexpr std::size_t kMostNumbers = 400'000;  // per page: about 2 MB as text

/// Number of ways that each obstacle may intend to take.
std::vector<std::size_t> way_counts(const Scenario& scenario) {
  std::vector<std::size_t> counts;
  for (const controller::Obstacle* one : controller::moving_obstacles(scenario.safe_set)) {
    counts.push_back(one->motion->ways.size());
  }
  return counts;
}

/// The stages that fit into the page.
std::vector<int> stages_of(const EpisodeView& view, std::size_t ways) {
  const int horizon = view.parts().stages;
  const std::size_t of_stage =
      std::max<std::size_t>(1, kNumbers * ways * view.trace().steps.size());
  const int most = static_cast<int>(std::min<std::size_t>(kMostStages, kMostNumbers / of_stage));
  if (horizon < 1 || most < 2) return {};
  return spread_stages(horizon, most);
}

/// Outlines relative to each obstacle's centre, as in the scenario.
Json outlines(const DrivenObstacles& others) {
  Json json = Json::array();
  for (std::size_t n = 0; n < others.count(); ++n) {
    const Eigen::Vector2d centre = controller::shape_centre(others.shape(n));
    const Eigen::Matrix2Xd corners = controller::shape_outline(others.shape(n));
    std::vector<double> values;
    for (const auto& corner : corners.colwise()) {
      values.insert(values.end(), {corner.x() - centre.x(), corner.y() - centre.y()});
    }
    json.push_back(packed_floats(values));
  }
  return json;
}

/// Poses as positions of the centres, and rotations. Obstacles whose final pose is unknown stay at
/// their last one.
std::string poses_of(const DrivenObstacles& others, std::size_t instants) {
  std::vector<double> values;
  for (std::size_t k = 0; k < instants; ++k) {
    const Eigen::Matrix3Xd& poses = others.poses()[std::min(k, others.poses().size() - 1)];
    for (std::size_t n = 0; n < others.count(); ++n) {
      const auto pose = poses.col(static_cast<Eigen::Index>(n));
      const Eigen::Vector2d at = controller::shape_centre(others.shape(n)) + pose.head<2>();
      values.insert(values.end(), {at.x(), at.y(), pose[2]});
    }
  }
  return packed_floats(values);
}

/// One weight per period and way, and one place per period, way and stage.
struct ForecastNumbers {
  std::vector<double> weights;
  std::vector<double> places;

  void add(const controller::ObstaclePlace& place, const Eigen::Vector2d& centre) {
    const Eigen::Vector2d mean = centre + place.offset;
    places.insert(places.end(), {mean.x(), mean.y(), place.covariance(0, 0), place.covariance(0, 1),
                                 place.covariance(1, 1)});
  }
  void add_unknown(std::size_t ways, std::size_t stages) {
    weights.insert(weights.end(), ways, kNotANumber);
    places.insert(places.end(), kNumbers * ways * stages, kNotANumber);
  }
};

ForecastNumbers forecasts_of(const EpisodeView& view, const DrivenObstacles& others,
                             const std::vector<std::size_t>& ways, const std::vector<int>& stages) {
  ForecastNumbers numbers;
  const std::vector<KnownForecasts> known = seen_forecasts(view.trace(), stages);
  for (std::size_t k = 0; k < known.size(); ++k) {
    const bool planned = view.trace().steps[k].plan_states.cols() > 0;
    for (std::size_t n = 0; n < others.count(); ++n) {
      if (!planned || n >= known[k].size()) {
        numbers.add_unknown(ways[n], stages.size());
        continue;
      }
      const Eigen::Vector2d centre = controller::shape_centre(others.shape(n));
      for (std::size_t way = 0; way < ways[n]; ++way) {
        numbers.weights.push_back(known[k][n].front()[way].weight);
        for (const auto& places : known[k][n]) numbers.add(places[way], centre);
      }
    }
  }
  return numbers;
}

}  // namespace

Json moving_data(const EpisodeView& view, const DrivenObstacles& others) {
  const std::vector<std::size_t> ways = way_counts(view.scenario());
  std::size_t all_ways = 0;
  for (const std::size_t count : ways) all_ways += count;
  const std::vector<int> stages = stages_of(view, all_ways);
  Json json = {{"outlines", outlines(others)},
               {"poses", poses_of(others, view.trace().steps.size() + 1)},
               {"ways", all_ways},
               {"stages", stages}};
  if (stages.empty()) return json;
  const ForecastNumbers numbers = forecasts_of(view, others, ways, stages);
  json["weights"] = packed_floats(numbers.weights);
  json["places"] = packed_floats(numbers.places);
  return json;
}

}  // namespace qsmpc::harness
