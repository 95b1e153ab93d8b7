#include "harness/figures/plane_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "harness/figures/map_content.hpp"
#include "harness/figures/map_labels.hpp"
#include "harness/figures/map_shapes.hpp"
#include "harness/text/html.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kMostLinePoints = 6000;  // per map; more would not be visible
constexpr std::size_t kMostRoadPoints = 1500;  // per line on the ground

bool has_sides(const MapRectangle& box) {
  return box.x_upper > box.x_lower && box.y_upper > box.y_lower;
}

MapCanvas canvas_of(const PlaneMap& map) {
  const bool given = map.area && is_finite(*map.area) && has_sides(*map.area);
  return MapCanvas(given ? *map.area : map_area(map));
}

std::string ground_svg(const PlaneMap& map, const MapCanvas& canvas) {
  std::string svg = canvas.rectangle("unsafe", unbounded_plane());
  svg += canvas.rectangle("free", map.bounds);
  for (const MapRectangle& box : map.obstacles) svg += canvas.rectangle("obstacle", box);
  for (const MapRectangle& box : map.partial_obstacles) svg += canvas.rectangle("partial", box);
  for (const MapPolygon& polygon : map.polygons) {
    svg += polygon_svg(canvas, polygon.corners, "obstacle");
  }
  for (const MapHalfPlane& half_plane : map.half_planes) {
    svg += half_plane_svg(canvas, half_plane, "obstacle");
  }
  for (const MapPath& line : map.lines) {
    svg +=
        fmt::format("<path class=\"{}\" d=\"{}\"/>\n", path_classes(line),
                    polyline_data(canvas, line.points, 1 + line.points.size() / kMostRoadPoints));
  }
  for (const MapCircle& target : map.targets) {
    if (!is_shown(target)) continue;
    const MapPoint at = canvas.place(target.centre);
    svg += fmt::format("<circle class=\"target\"{} cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>\n",
                       target.is_waypoint ? kWaypointStyle : "", at.x, at.y,
                       canvas.length(target.radius));
  }
  return svg;
}

/// The stride n for which drawing every n-th point keeps the total size of all lines limited.
std::size_t line_stride(const PlaneMap& map) {
  std::size_t count = 0;
  for (const MapPath& path : map.paths) count += path.points.size();
  for (const MapContours& contours : map.contours) {
    for (const MapContour& line : contours.lines) {
      count += static_cast<std::size_t>(line.points.cols());
    }
  }
  return 1 + count / kMostLinePoints;
}

std::string contours_svg(const PlaneMap& map, const MapCanvas& canvas) {
  std::string svg;
  for (const MapContours& contours : map.contours) {
    for (const MapContour& line : contours.lines) {
      const std::string data = polyline_data(canvas, points_of(line.points), line_stride(map));
      if (data.empty()) continue;
      const double opacity =
          std::isfinite(line.mass) ? 1.0 - 0.5 * std::clamp(line.mass, 0., 1.) : 1.0;
      svg += fmt::format("<path class=\"outline {}\" stroke-opacity=\"{:.2f}\" d=\"{}\"/>\n",
                         colour_class(contours.colour), opacity, data);
    }
  }
  return svg;
}

std::string clouds_svg(const PlaneMap& map, const MapCanvas& canvas) {
  const std::vector<std::vector<MapDot>> dots = dots_of(map);
  std::string svg;
  for (std::size_t n = 0; n < dots.size(); ++n) {
    svg += dots_svg(canvas, dots[n], "dots " + colour_class(map.clouds[n].colour));
  }
  return svg;
}

std::string ellipses_svg(const PlaneMap& map, const MapCanvas& canvas) {
  std::string svg;
  for (const MapEllipse& ellipse : map.ellipses) {
    if (!is_shown(ellipse)) continue;
    for (const double level : ellipse.levels) {
      if (!is_shown(level)) continue;
      svg += ellipse_svg(canvas, ellipse.mean, ellipse.covariance, level,
                         "outline " + colour_class(ellipse.colour));
    }
  }
  return svg;
}

std::string paths_svg(const PlaneMap& map, const MapCanvas& canvas, bool faint) {
  std::string svg;
  for (const MapPath& path : map.paths) {
    if (path.faint != faint) continue;
    const std::string data = polyline_data(canvas, path.points, line_stride(map));
    if (data.empty()) continue;
    svg += "<path class=\"" + path_classes(path) + "\" d=\"" + data + "\"/>\n";
    if (path.arrow_period <= 0) continue;
    const auto period = static_cast<std::size_t>(path.arrow_period);
    for (std::size_t k = period / 2; k < path.points.size(); k += period) {
      svg += arrow_svg(canvas, path.points, k, "arrow " + colour_class(path.colour));
    }
  }
  return svg;
}

std::string bodies_svg(const PlaneMap& map, const MapCanvas& canvas) {
  std::string svg;
  for (const MapBody& body : map.bodies) {
    const std::string data = arcs_data(canvas, body.arcs);
    if (data.empty()) continue;
    svg += "<path class=\"" + body_classes(body) + "\" d=\"" + data + "\"/>\n";
  }
  return svg;
}

/// The marks at the first and last drawable points of the paths.
std::string marks_svg(const PlaneMap& map, const MapCanvas& canvas) {
  const auto drawable = [](const MapPoint& point) { return is_drawable(point); };
  std::string svg;
  for (const MapPath& path : map.paths) {
    const auto first = std::find_if(path.points.begin(), path.points.end(), drawable);
    const auto last = std::find_if(path.points.rbegin(), path.points.rend(), drawable);
    if (first == path.points.end()) continue;
    for (const auto& [mark, at] : {std::pair(path.start_mark, *first), {path.end_mark, *last}}) {
      if (mark == MapMark::kNone) continue;
      svg += mark_svg(canvas, at, mark == MapMark::kSquare, colour_class(path.colour));
    }
  }
  return svg;
}

/// `count` points around the outermost outline, from the lower right.
std::vector<MapPoint> outline_of(const MapEllipse& ellipse, int count) {
  double outermost = 0.0;
  for (const double level : ellipse.levels) {
    if (is_shown(level)) outermost = std::max(outermost, level);
  }
  const Eigen::Matrix2d root = principal_axes(ellipse.covariance);
  const double radius = std::sqrt(-2.0 * std::log1p(-outermost));
  std::vector<MapPoint> outline;
  for (int n = 0; n < count; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / count;
    const Eigen::Vector2d at =
        ellipse.mean + radius * root * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    outline.push_back({.x = at.x(), .y = at.y()});
  }
  return outline;
}

/// Points on everything that texts should not cover.
std::vector<MapPoint> ink_of(const PlaneMap& map) {
  constexpr int kOutlinePoints = 48;
  const std::size_t stride = line_stride(map);
  std::vector<MapPoint> ink;
  for (const MapPath& path : map.paths) {
    if (path.faint || path.dashed) continue;
    for (std::size_t i = 0; i < path.points.size(); i += stride) {
      ink.push_back(path.points[i]);
    }
  }
  for (const MapEllipse& ellipse : map.ellipses) {
    if (!is_shown(ellipse)) continue;
    const std::vector<MapPoint> outline = outline_of(ellipse, kOutlinePoints);
    ink.insert(ink.end(), outline.begin(), outline.end());
  }
  std::erase_if(ink, [](const MapPoint& point) { return !is_drawable(point); });
  return ink;
}

std::string labels_svg(const PlaneMap& map, const MapCanvas& canvas) {
  constexpr int kPlaces = 24;  // candidates around an ellipse
  std::vector<PlacedText> texts;
  for (const MapLabel& label : map.labels) {
    if (is_drawable(label.at)) texts.push_back({.text = label.text, .at = label.at});
  }
  for (const MapEllipse& ellipse : map.ellipses) {
    if (!is_shown(ellipse) || ellipse.label.empty()) continue;
    texts.push_back({.text = ellipse.label,
                     .at = {.x = ellipse.mean.x(), .y = ellipse.mean.y()},
                     .outline = outline_of(ellipse, kPlaces)});
  }
  return texts_svg(canvas, texts, ink_of(map));
}

}  // namespace

MapSize map_size(const PlaneMap& map) { return canvas_of(map).size(); }

MapView map_view(const PlaneMap& map) { return canvas_of(map).view(); }

std::string map_drawing(const PlaneMap& map, double x, double y) {
  const MapCanvas canvas = canvas_of(map);
  // Only if embedded in another drawing; a page leaves position and size to its style.
  const std::string place =
      x == 0.0 && y == 0.0
          ? ""
          : fmt::format(" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"", x, y,
                        canvas.size().width, canvas.size().height);
  const std::string content = ground_svg(map, canvas) + movers_svg(canvas, map.movers) +
                              contours_svg(map, canvas) + clouds_svg(map, canvas) +
                              bodies_svg(map, canvas) + paths_svg(map, canvas, true) +
                              ellipses_svg(map, canvas) + paths_svg(map, canvas, false) +
                              marks_svg(map, canvas) + labels_svg(map, canvas);
  return canvas.svg(content, {.title = map.title, .x_label = map.x_label, .y_label = map.y_label},
                    place);
}

std::string map_figure(const PlaneMap& map) {
  std::string html =
      "<figure class=\"card\">\n<figcaption>" + escape_html(map.title) + "</figcaption>\n";
  const std::string note = map_note(map);
  if (!note.empty()) html += "<p class=\"note\">" + escape_html(note) + "</p>\n";
  if (has_content(map)) {
    html += legend_html(map_legend(map)) + map_drawing(map);
  } else {
    html += "<p class=\"empty\">No finite values to draw.</p>\n";
  }
  return html + "</figure>\n";
}

}  // namespace qsmpc::harness
