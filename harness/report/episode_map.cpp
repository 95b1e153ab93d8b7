#include "harness/report/episode_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "harness/report/map_canvas.hpp"
#include "harness/report/numbers.hpp"
#include "harness/report/page_style.hpp"

namespace qsmpc {
namespace {

constexpr int kSnapshotPeriod = 10;  // steps from one snapshot to the next, at least
constexpr int kMostSnapshots = 20;
constexpr Eigen::Index kMostParticles = 120;  // of one stage of one snapshot
constexpr std::size_t kMostPathPoints = 2000;
constexpr double kArrowSize = 7.0;  // view box units
constexpr int kBeliefColour = kBlue;
constexpr int kLastStageColour = kOrange;

class EpisodeMap {
 public:
  EpisodeMap(const Trace& trace, const SystemDescription& system)
      : trace_(trace), system_(system), path_(driven_path()), canvas_(area()) {}

  [[nodiscard]] std::string figure() const {
    const std::string content = ground() + snapshots() + path() + ends() + times();
    const std::string caption =
        trace_.steps.empty()
            ? "Map"
            : fmt::format("Map: belief and plan every {} steps", snapshot_period());
    return "<figure class=\"card\">\n<figcaption>" + caption + "</figcaption>\n" + legend() +
           canvas_.svg(content, "Map of the episode", label(system_.position_x),
                       label(system_.position_y)) +
           "</figure>\n";
  }

 private:
  [[nodiscard]] MapPoint point_of(const Eigen::Ref<const Eigen::VectorXd>& state) const {
    if (state.size() <= std::max(system_.position_x, system_.position_y)) {
      return {.x = std::numeric_limits<double>::quiet_NaN()};
    }
    return {.x = state[system_.position_x], .y = state[system_.position_y]};
  }

  [[nodiscard]] MapRectangle rectangle_of(const Box& box) const {
    return {.x_lower = box.lower[system_.position_x],
            .x_upper = box.upper[system_.position_x],
            .y_lower = box.lower[system_.position_y],
            .y_upper = box.upper[system_.position_y]};
  }

  [[nodiscard]] std::string label(int coordinate) const {
    const Coordinate& state = system_.states[static_cast<std::size_t>(coordinate)];
    return state.name + " (" + state.unit + ")";
  }

  [[nodiscard]] std::vector<MapPoint> driven_path() const {
    std::vector<MapPoint> path;
    for (const StepRecord& step : trace_.steps) path.push_back(point_of(step.state));
    if (trace_.final_state.size() > 0) path.push_back(point_of(trace_.final_state));
    std::erase_if(path, [](const MapPoint& point) { return !is_drawable(point); });
    return path;
  }

  /// One axis of what is shown: the bounds, where they are finite, and what lies about them; a
  /// state that ran away far beyond is cut off, so that the rest stays visible.
  [[nodiscard]] static Axis shown(double lower, double upper, const std::vector<double>& contents) {
    constexpr double kMargin = 0.04;  // of the length, on each side
    Axis axis = tight_axis(contents);
    if (std::isfinite(lower) && std::isfinite(upper)) {
      const double length = upper - lower;
      axis.lower = std::clamp(axis.lower, lower - length, lower);
      axis.upper = std::clamp(axis.upper, upper, upper + length);
    }
    const double margin = kMargin * (axis.upper - axis.lower);
    return {.lower = axis.lower - margin, .upper = axis.upper + margin};
  }

  [[nodiscard]] MapRectangle area() const {
    const Scenario& scenario = trace_.scenario;
    const MapPoint target = point_of(scenario.target.state);
    const double radius = scenario.target.radius;
    std::vector<double> across = {target.x - radius, target.x + radius};
    std::vector<double> up = {target.y - radius, target.y + radius};
    for (const MapPoint& point : path_) {
      across.push_back(point.x);
      up.push_back(point.y);
    }
    for (const Box& obstacle : scenario.safe_set.obstacles) {
      const MapRectangle box = rectangle_of(obstacle);
      across.insert(across.end(), {box.x_lower, box.x_upper});
      up.insert(up.end(), {box.y_lower, box.y_upper});
    }
    const MapRectangle bounds = rectangle_of(scenario.safe_set.bounds);
    const Axis x = shown(bounds.x_lower, bounds.x_upper, across);
    const Axis y = shown(bounds.y_lower, bounds.y_upper, up);
    return {.x_lower = x.lower, .x_upper = x.upper, .y_lower = y.lower, .y_upper = y.upper};
  }

  /// Whether the box restricts nothing but the position, so that it is unsafe as a whole.
  [[nodiscard]] bool is_planar(const Box& box) const {
    for (Eigen::Index i = 0; i < box.lower.size(); ++i) {
      if (i == system_.position_x || i == system_.position_y) continue;
      if (std::isfinite(box.lower[i]) || std::isfinite(box.upper[i])) return false;
    }
    return true;
  }

  [[nodiscard]] std::string ground() const {
    const SafeSet& safe_set = trace_.scenario.safe_set;
    constexpr double kFar = std::numeric_limits<double>::infinity();
    std::string svg = canvas_.rectangle("unsafe", {-kFar, kFar, -kFar, kFar});
    svg += canvas_.rectangle("free", rectangle_of(safe_set.bounds));
    for (const Box& obstacle : safe_set.obstacles) {
      svg +=
          canvas_.rectangle(is_planar(obstacle) ? "obstacle" : "partial", rectangle_of(obstacle));
    }
    const MapPoint target = canvas_.place(point_of(trace_.scenario.target.state));
    return svg +
           fmt::format("<circle class=\"target\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>\n",
                       target.x, target.y, canvas_.length(trace_.scenario.target.radius));
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

  /// A stage's points, in three sizes by weight.
  [[nodiscard]] std::string dots(const StageParticles& stage, int colour) const {
    std::array<std::string, 3> data;
    const Eigen::Index stride = 1 + (stage.size() - 1) / kMostParticles;
    for (Eigen::Index i = 0; i < stage.size(); i += stride) {
      const MapPoint point = point_of(stage.locations.col(i));
      if (!is_drawable(point)) continue;
      const double share = stage.weights[i] * static_cast<double>(stage.size());  // 1: average
      const std::size_t size = share < 0.5 ? 0 : share < 2.0 ? 1 : 2;
      data.at(size) += "M" + canvas_.coordinates(point) + "h0";
    }
    std::string svg;
    for (std::size_t size = 0; size < data.size(); ++size) {
      if (data.at(size).empty()) continue;
      svg += fmt::format("<path class=\"dots w{} c{}\" d=\"{}\"/>\n", size, colour, data.at(size));
    }
    return svg;
  }

  [[nodiscard]] std::string snapshots() const {
    std::string last_stages;
    std::string beliefs;
    std::string plans;
    for (const StepRecord* step : snapshot_steps()) {
      if (step->particles.size() > 1) {
        last_stages += dots(step->particles.back(), kLastStageColour);
      }
      if (!step->particles.empty()) beliefs += dots(step->particles.front(), kBeliefColour);
      std::vector<MapPoint> nominal;
      for (Eigen::Index s = 0; s < step->plan_states.cols(); ++s) {
        nominal.push_back(point_of(step->plan_states.col(s)));
      }
      plans += "<path class=\"plan\" d=\"" + polyline(nominal) + "\"/>\n";
    }
    return last_stages + beliefs + plans;
  }

  [[nodiscard]] std::string polyline(const std::vector<MapPoint>& points) const {
    std::string data;
    const std::size_t stride = 1 + points.size() / kMostPathPoints;
    for (std::size_t i = 0; i < points.size(); i += stride) {
      if (!is_drawable(points[i])) continue;
      data += (data.empty() ? "M" : "L") + canvas_.coordinates(points[i]);
    }
    if (points.size() > 1 && is_drawable(points.back()) && !data.empty()) {
      data += "L" + canvas_.coordinates(points.back());
    }
    return data;
  }

  /// An open arrowhead at point k of the path, along the way over some steps about it: a single
  /// one is mostly its disturbance. Empty where the way stands.
  [[nodiscard]] std::string arrow(std::size_t k) const {
    constexpr std::size_t kReach = 3;  // steps to each side
    const MapPoint from = canvas_.place(path_[k - std::min(k, kReach)]);
    const MapPoint to = canvas_.place(path_[std::min(k + kReach, path_.size() - 1)]);
    const MapPoint tip = canvas_.place(path_[k]);
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    constexpr double kLeastLength = 1.0;  // view box units; below it, the direction is noise
    if (!(length > kLeastLength)) return {};
    const double x = kArrowSize * (to.x - from.x) / length;
    const double y = kArrowSize * (to.y - from.y) / length;
    return fmt::format("<path class=\"arrow\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}\"/>\n",
                       tip.x - x - 0.7 * y, tip.y - y + 0.7 * x, tip.x, tip.y, tip.x - x + 0.7 * y,
                       tip.y - y - 0.7 * x);
  }

  [[nodiscard]] std::string path() const {
    std::string svg = "<path class=\"way\" d=\"" + polyline(path_) + "\"/>\n";
    const auto period = static_cast<std::size_t>(snapshot_period());
    for (std::size_t k = period / 2; k < path_.size(); k += period) svg += arrow(k);
    return svg;
  }

  [[nodiscard]] std::string ends() const {
    if (path_.empty()) return {};
    const MapPoint start = canvas_.place(path_.front());
    const MapPoint end = canvas_.place(path_.back());
    constexpr double kSize = 4.5;
    return fmt::format(
        "<circle class=\"here\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>"
        "<rect class=\"here\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\"/>\n",
        start.x, start.y, kSize, end.x - kSize, end.y - kSize, 2.0 * kSize, 2.0 * kSize);
  }

  /// The time at each snapshot, beside the path.
  [[nodiscard]] std::string times() const {
    std::string svg;
    for (const StepRecord* step : snapshot_steps()) {
      const MapPoint point = point_of(step->state);
      if (!is_drawable(point)) continue;
      const MapPoint at = canvas_.place(point);
      svg += fmt::format("<text class=\"time\" x=\"{:.1f}\" y=\"{:.1f}\">{} s</text>\n", at.x + 9.0,
                         at.y + 15.0, format_short(step->time));
    }
    return svg;
  }

  [[nodiscard]] static std::string entry(const std::string& drawing, const std::string& name) {
    return "<li><svg class=\"swatch\" viewBox=\"0 0 28 12\" aria-hidden=\"true\">" + drawing +
           "</svg>" + name + "</li>";
  }

  [[nodiscard]] static std::string area_entry(const std::string& css_class,
                                              const std::string& name) {
    return entry("<rect class=\"" + css_class + "\" x=\"6\" y=\"1\" width=\"16\" height=\"10\"/>",
                 name);
  }

  [[nodiscard]] static std::string dot_entry(int colour, const std::string& name) {
    return entry(fmt::format("<path class=\"points c{}\" d=\"M14 6h0\"/>", colour), name);
  }

  [[nodiscard]] std::string drive_legend() const {
    return entry("<path class=\"way\" d=\"M2 6H26\"/>", "driven path, from dot to square") +
           dot_entry(kBeliefColour, "belief (stage 0)") +
           dot_entry(kLastStageColour,
                     fmt::format("prediction (stage {})", trace_.scenario.controller.horizon)) +
           entry("<path class=\"plan\" d=\"M2 6H26\"/>", "nominal plan");
  }

  [[nodiscard]] std::string legend() const {
    const auto& obstacles = trace_.scenario.safe_set.obstacles;
    const auto planar = std::count_if(obstacles.begin(), obstacles.end(),
                                      [this](const Box& box) { return is_planar(box); });
    std::string html = "<ul class=\"legend\">";
    if (!trace_.steps.empty()) html += drive_legend();
    html += entry("<circle class=\"target\" cx=\"14\" cy=\"6\" r=\"5\"/>", "target");
    if (planar > 0) html += area_entry("obstacle", "obstacle");
    if (planar < std::ssize(obstacles)) {
      html += area_entry("partial", "obstacle for some of the other states");
    }
    return html + area_entry("unsafe", "outside of the bounds") + "</ul>\n";
  }

  const Trace& trace_;
  const SystemDescription& system_;
  std::vector<MapPoint> path_;
  MapCanvas canvas_;
};

}  // namespace

std::string episode_map(const Trace& trace, const SystemDescription& system) {
  if (system.position_x < 0 || system.position_y < 0) return {};
  return EpisodeMap(trace, system).figure();
}

}  // namespace qsmpc
