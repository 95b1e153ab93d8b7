#include "harness/figures/map_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "models/linear_algebra.hpp"

namespace qsmpc::harness {
namespace {

// View box units.
constexpr double kArrowSize = 7.0;
constexpr double kLeastLength = 0.05;  // anything shorter rounds to zero

}  // namespace

std::string polyline_data(const MapCanvas& canvas, const std::vector<MapPoint>& points,
                          std::size_t stride) {
  std::string data;
  std::string last;    // coordinates; empty: the line is interrupted
  bool alone = false;  // whether only a move leads to `last`
  const auto interrupt = [&] {
    if (alone) data += "h0";
    alone = false;
    last.clear();
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool is_last = i + 1 == points.size();
    if (i % stride != 0 && !is_last) continue;
    if (!is_drawable(points[i])) {
      interrupt();
      continue;
    }
    const std::string at = canvas.coordinates(points[i]);
    if (at == last) continue;
    alone = last.empty();
    data += (alone ? "M" : "L") + at;
    last = at;
  }
  interrupt();
  return data;
}

std::string arrow_svg(const MapCanvas& canvas, const std::vector<MapPoint>& points, std::size_t k,
                      const std::string& classes) {
  constexpr std::size_t kReach = 3;  // points to each side
  const std::array<MapPoint, 3> ends = {points[k - std::min(k, kReach)], points[k],
                                        points[std::min(k + kReach, points.size() - 1)]};
  for (const MapPoint& end : ends) {
    if (!is_drawable(end)) return {};
  }
  const MapPoint from = canvas.place(ends[0]);
  const MapPoint tip = canvas.place(ends[1]);
  const MapPoint to = canvas.place(ends[2]);
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  constexpr double kLeastWay = 1.0;  // view box units; below it, the direction is noise
  if (!(length > kLeastWay)) return {};
  const double x = kArrowSize * (to.x - from.x) / length;
  const double y = kArrowSize * (to.y - from.y) / length;
  return fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}\"/>\n",
                     classes, tip.x - x - 0.7 * y, tip.y - y + 0.7 * x, tip.x, tip.y,
                     tip.x - x + 0.7 * y, tip.y - y - 0.7 * x);
}

Eigen::Matrix2d principal_axes(const Eigen::Matrix2d& covariance) {
  const models::SymmetricEigen principal = models::symmetric_eigen(covariance);
  const Eigen::Vector2d deviations = principal.values.cwiseMax(0.0).cwiseSqrt();
  return principal.vectors * deviations.asDiagonal();
}

std::string ellipse_svg(const MapCanvas& canvas, const Eigen::Vector2d& mean,
                        const Eigen::Matrix2d& covariance, double level,
                        const std::string& classes) {
  // χ² with two degrees of freedom is below −2 ln(1 − p) with probability p.
  const double radius = std::sqrt(-2.0 * std::log1p(-level));
  const Eigen::Matrix2d axes = radius * principal_axes(covariance);
  const Eigen::Vector2d along = axes.col(1);
  const Eigen::Vector2d one = mean - along;
  const Eigen::Vector2d other = mean + along;
  const std::string from = canvas.coordinates({.x = one.x(), .y = one.y()});
  const std::string to = canvas.coordinates({.x = other.x(), .y = other.y()});
  const double longer = canvas.length(along.norm());
  const double shorter = canvas.length(axes.col(0).norm());
  std::string data;
  std::string shape = classes;
  if (longer < kLeastLength) {
    data = "M" + from + "h0";
    shape += " spot";
  } else if (shorter < kLeastLength) {
    data = "M" + from + "L" + to;
  } else {
    const double turn = -std::atan2(along.y(), along.x()) * 180.0 / std::numbers::pi;
    const std::string arc = fmt::format("A{:.2f} {:.2f} {:.1f} 0 0 ", longer, shorter, turn);
    data = "M" + from + arc + to + arc + from + "Z";
  }
  return "<path class=\"" + shape + "\" d=\"" + data + "\"/>\n";
}

std::string dots_svg(const MapCanvas& canvas, const std::vector<MapDot>& dots,
                     const std::string& classes) {
  // Diameters in view box units. The inked area does not depend on the number of points: 100 points
  // of equal weight are 3 units wide each.
  constexpr double kDiameterOfAll = 30.0;
  constexpr double kLeastDiameter = 1.8;
  constexpr double kGreatestDiameter = 10.0;
  constexpr double kStep = 0.2;  // dots of equal size, to this accuracy, share one element
  std::map<int, std::string> by_size;
  for (const MapDot& dot : dots) {
    const double diameter =
        std::clamp(kDiameterOfAll * std::sqrt(dot.share), kLeastDiameter, kGreatestDiameter);
    by_size[static_cast<int>(std::lround(diameter / kStep))] +=
        "M" + canvas.coordinates(dot.at) + "h0";
  }
  std::string svg;
  for (const auto& [size, data] : by_size) {
    svg += fmt::format("<path class=\"{}\" stroke-width=\"{:.1f}\" d=\"{}\"/>\n", classes,
                       kStep * size, data);
  }
  return svg;
}

std::string mark_svg(const MapCanvas& canvas, const MapPoint& at, bool square,
                     const std::string& classes) {
  const std::string shape = square ? "mark square" : "mark";
  // Some renderers draw square caps only on a line of non-zero length.
  const std::string data = "M" + canvas.coordinates(at) + (square ? "h0.1" : "h0");
  return "<path class=\"" + shape + " edge\" d=\"" + data + "\"/><path class=\"" + shape + " " +
         classes + "\" d=\"" + data + "\"/>\n";
}

std::string arcs_data(const MapCanvas& canvas, const std::vector<controller::Arc>& arcs) {
  std::string data;
  for (const controller::Arc& arc : arcs) {
    const auto at = [&](double angle) {
      const Eigen::Vector2d point =
          arc.centre + arc.radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      return MapPoint{.x = point.x(), .y = point.y()};
    };
    if (!is_drawable(at(arc.from)) || !is_drawable(at(arc.to))) continue;
    data += "M" + canvas.coordinates(at(arc.from));
    // In two halves: SVG draws nothing for an arc of a full turn.
    for (const double angle : {0.5 * (arc.from + arc.to), arc.to}) {
      data += fmt::format("A{0:.1f} {0:.1f} 0 0 0 {1}", canvas.length(arc.radius),
                          canvas.coordinates(at(angle)));
    }
  }
  return data;
}

}  // namespace qsmpc::harness
