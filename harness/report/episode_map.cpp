#include "harness/report/episode_map.hpp"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/figures/ground_map.hpp"
#include "harness/figures/palette.hpp"
#include "harness/figures/plane_map.hpp"
#include "harness/report/driven_ways.hpp"
#include "harness/report/line_colours.hpp"
#include "harness/text/number_format.hpp"
#include "harness/trace/target_progress.hpp"

namespace qsmpc::harness {
namespace {

constexpr int kSnapshotPeriod = 10;  // least number of steps from one snapshot to the next
constexpr int kMostSnapshots = 20;

std::string words_of(const models::Coordinate& state) {
  std::string words = state.name;
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

// The map's title by its axes: "Map", or e.g. "Position and pole angle".
std::string map_words(const models::SystemDescription& system) {
  const MapAxes axes = map_axes(system).value();
  if (axes.is_plane) return "Map";
  std::string words = words_of(system.states[static_cast<std::size_t>(axes.x)]) + " and " +
                      words_of(system.states[static_cast<std::size_t>(axes.y)]);
  words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  return words;
}

class EpisodeMap {
 public:
  explicit EpisodeMap(const EpisodeView& view)
      : view_(view), states_(view.states()), trace_(view.trace()), system_(view.system()) {}

  [[nodiscard]] EpisodeMaps maps() const {
    EpisodeMaps maps{.drive = ground(), .ground = ground()};
    maps.drive.movers = driven_ways(view_, DrivenObstacles(trace_));
    maps.drive.paths.push_back(driven_path());
    // The axes are set by the drive, so that a diverging prediction does not shrink it.
    maps.drive.area = map_area(maps.drive);
    maps.ground.area = maps.drive.area;
    add_waypoints(maps.drive);
    add_bodies(maps.drive);
    add_snapshots(maps.drive);
    if (trace_.scenario.target.course && !trace_.steps.empty()) {
      add_laps(maps.drive);
      for (const LineColours& colours : {speed_colours(trace_), risk_colours(trace_)}) {
        PlaneMap map = maps.ground;
        map.title = colours.title;
        map.note = colours.note;
        for (MapPath& piece : coloured_line(colours, driven_path().points)) {
          map.paths.push_back(std::move(piece));
        }
        add_laps(map);
        maps.coloured.push_back(std::move(map));
      }
    }
    return maps;
  }

 private:
  [[nodiscard]] MapPoint point_of(const Eigen::Ref<const Eigen::VectorXd>& state) const {
    return map_point(state, system_);
  }

  [[nodiscard]] MapPath driven_path() const {
    MapPath path{.name = trace_.steps.empty() ? "" : "driven path, from dot to square",
                 .colour = kInk,
                 .start_mark = MapMark::kDot,
                 .end_mark = MapMark::kSquare,
                 .arrow_period = snapshot_period()};
    for (const auto& state : states_.colwise()) path.points.push_back(point_of(state));
    return path;
  }

  /// Labels the line with the time of each lap.
  void add_laps(PlaneMap& map) const {
    const std::optional<Laps> laps = laps_of(trace_);
    if (!laps || laps->times.empty()) return;
    const controller::PathTarget& course = *trace_.scenario.target.course;
    const Eigen::Vector2d line = course.path->at(course.begin).position;
    std::string text;
    for (std::size_t n = 0; n < laps->times.size(); ++n) {
      text +=
          fmt::format("{}lap {}: {} s", n > 0 ? ", " : "", n + 1, format_short(laps->times[n], 4));
    }
    map.labels.push_back({.text = text, .at = {.x = line.x(), .y = line.y()}});
  }

  /// Labels waypoints with their order, and with the time if passed.
  void add_waypoints(PlaneMap& map) const {
    const std::optional<WaypointTimes> passed = waypoint_times(trace_);
    if (!passed) return;
    const Eigen::MatrixXd& states = trace_.scenario.target.route->states;
    for (std::size_t n = 0; n < static_cast<std::size_t>(passed->wanted); ++n) {
      std::string text = fmt::format("{}", n + 1);
      if (n < passed->times.size()) {
        text += fmt::format(": {} s", format_short(passed->times[n], 4));
      } else if (!trace_.steps.empty()) {
        text += ": not passed";
      }
      map.labels.push_back(
          {.text = std::move(text), .at = point_of(states.col(static_cast<Eigen::Index>(n)))});
    }
  }

  /// Adds the vehicle's body at each snapshot, and where the drive ended.
  void add_bodies(PlaneMap& map) const {
    const controller::Body& body = trace_.scenario.safe_set.body;
    if (body.is_point()) return;
    const auto add = [&](const Eigen::Ref<const Eigen::VectorXd>& state) {
      const MapPoint at = point_of(state);
      if (!is_drawable(at)) return;
      const double heading = body.heading < 0 ? 0.0 : state[body.heading];
      map.bodies.push_back({.name = "body of the vehicle",
                            .colour = kInk,
                            .arcs = controller::body_outline(body, {at.x, at.y}, heading)});
    };
    for (const StepRecord* step : snapshot_steps()) add(step->state);
    if (states_.cols() > 0) add(states_.col(states_.cols() - 1));
  }

  [[nodiscard]] PlaneMap ground() const {
    PlaneMap map = ground_map(standing_scenario(trace_.scenario), system_);
    const std::string name = map_words(system_);
    map.title = trace_.steps.empty()
                    ? name
                    : fmt::format("{}: belief and plan every {} steps", name, snapshot_period());
    return map;
  }

  [[nodiscard]] int snapshot_period() const {
    const int steps = static_cast<int>(trace_.steps.size());
    const int needed = (steps + kMostSnapshots - 1) / kMostSnapshots;
    return std::max(kSnapshotPeriod,
                    (needed + kSnapshotPeriod - 1) / kSnapshotPeriod * kSnapshotPeriod);
  }

  [[nodiscard]] std::vector<const StepRecord*> snapshot_steps() const {
    std::vector<const StepRecord*> steps;
    const auto period = static_cast<std::size_t>(snapshot_period());
    for (std::size_t k = 0; k < trace_.steps.size(); k += period) steps.push_back(&trace_.steps[k]);
    return steps;
  }

  [[nodiscard]] MapCloud cloud_of(const StageParticles& stage, int colour,
                                  const std::string& name) const {
    MapCloud cloud{.name = name,
                   .colour = colour,
                   .points = Eigen::Matrix2Xd(2, stage.size()),
                   .weights = stage.weights};
    for (Eigen::Index i = 0; i < stage.size(); ++i) {
      const MapPoint point = point_of(stage.locations.col(i));
      cloud.points.col(i) << point.x, point.y;
    }
    return cloud;
  }

  [[nodiscard]] MapPath plan_of(const StepRecord& step) const {
    MapPath plan{.name = "nominal plan", .colour = kGrey, .dashed = true};
    for (Eigen::Index s = 0; s < step.plan_states.cols(); ++s) {
      plan.points.push_back(point_of(step.plan_states.col(s)));
    }
    return plan;
  }

  /// Draws beliefs above predictions, and the driven path above the plans.
  void add_snapshots(PlaneMap& map) const {
    const std::vector<const StepRecord*> steps = snapshot_steps();
    const std::string last_stage =
        fmt::format("prediction (stage {})", trace_.scenario.controller.horizon);
    for (const StepRecord* step : steps) {
      if (step->particles.size() < 2) continue;
      map.clouds.push_back(cloud_of(step->particles.back(), kLastStage, last_stage));
    }
    std::vector<MapPath> plans;
    for (const StepRecord* step : steps) {
      if (!step->particles.empty()) {
        map.clouds.push_back(cloud_of(step->particles.front(), kFirstStage, "belief (stage 0)"));
      }
      plans.push_back(plan_of(*step));
      // The time at each snapshot, beside the path.
      map.labels.push_back({.text = format_short(step->time) + " s", .at = point_of(step->state)});
    }
    map.paths.insert(map.paths.begin(), plans.begin(), plans.end());
  }

  const EpisodeView& view_;
  const Eigen::MatrixXd& states_;
  const Trace& trace_;
  const models::SystemDescription& system_;
};

}  // namespace

std::optional<EpisodeMaps> episode_maps(const EpisodeView& view) {
  if (!map_axes(view.system())) return std::nullopt;
  return EpisodeMap(view).maps();
}

}  // namespace qsmpc::harness
