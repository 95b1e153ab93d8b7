// The legend and the note of a map.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/figures/map_content.hpp"
#include "harness/figures/plane_map.hpp"
#include "harness/text/number_format.hpp"

namespace qsmpc::harness {
namespace {

/// The distinct valid probabilities in order.
std::vector<double> tidy(std::vector<double> shares) {
  std::erase_if(shares, [](double share) { return !is_shown(share); });
  std::sort(shares.begin(), shares.end());
  shares.erase(std::unique(shares.begin(), shares.end()), shares.end());
  return shares;
}

/// "25, 50 and 95 %"
std::string percentages(const std::vector<double>& shares) {
  std::string text;
  for (std::size_t n = 0; n < shares.size(); ++n) {
    if (n > 0) text += n + 1 == shares.size() ? " and " : ", ";
    text += format_short(100.0 * shares[n]);
  }
  return text + " %";
}

std::vector<double> levels_of(const MapEllipse& ellipse) { return tidy(ellipse.levels); }

std::vector<double> levels_of(const MapContours& contours) {
  std::vector<double> masses;
  for (const MapContour& line : contours.lines) masses.push_back(line.mass);
  return tidy(masses);
}

/// The levels common to all of `drawings`; empty if they differ.
template <class Drawing>
std::vector<double> common_levels(const std::vector<Drawing>& drawings) {
  std::vector<double> common;
  for (const Drawing& drawing : drawings) {
    const std::vector<double> levels = levels_of(drawing);
    if (!common.empty() && levels != common) return {};
    common = levels;
  }
  return common;
}

/// The legend name of one of `drawings`, with its levels unless the note states them for all.
template <class Drawing>
std::string name_of(const Drawing& drawing, const std::vector<Drawing>& drawings) {
  const std::vector<double> levels = levels_of(drawing);
  if (drawing.name.empty() || levels.empty() || !common_levels(drawings).empty()) {
    return drawing.name;
  }
  return drawing.name + ": " + percentages(levels);
}

void add_entry(std::vector<LegendEntry>& entries, LegendEntry entry) {
  if (entry.name.empty()) return;
  if (std::find(entries.begin(), entries.end(), entry) == entries.end()) {
    entries.push_back(std::move(entry));
  }
}

void add_ground_entries(std::vector<LegendEntry>& entries, const PlaneMap& map) {
  const auto has = [&](bool waypoint) {
    return std::ranges::any_of(map.targets, [&](const MapCircle& target) {
      return target.is_waypoint == waypoint && is_shown(target);
    });
  };
  if (has(false)) {
    add_entry(entries, {.drawing = "<circle class=\"target\" cx=\"14\" cy=\"6\" r=\"5\"/>",
                        .name = "target"});
  }
  if (has(true)) {
    add_entry(entries,
              {.drawing = fmt::format("<circle class=\"target\"{} cx=\"14\" cy=\"6\" r=\"5\"/>",
                                      kWaypointStyle),
               .name = "waypoint"});
  }
  if (!map.obstacles.empty() || !map.polygons.empty() || !map.half_planes.empty()) {
    add_entry(entries, area_entry("obstacle", "obstacle"));
  }
  if (!map.partial_obstacles.empty()) {
    add_entry(entries, area_entry("partial", "obstacle for some values of the other states"));
  }
  const MapRectangle& bounds = map.bounds;
  if (std::isfinite(bounds.x_lower) || std::isfinite(bounds.x_upper) ||
      std::isfinite(bounds.y_lower) || std::isfinite(bounds.y_upper)) {
    add_entry(entries, area_entry("unsafe", "outside of the bounds"));
  }
}

}  // namespace

std::vector<LegendEntry> map_legend(const PlaneMap& map) {
  std::vector<LegendEntry> entries;
  for (const MapPath& path : map.paths) {
    add_entry(entries, line_entry(path_classes(path), path.name));
  }
  for (const MapPath& line : map.lines) {
    add_entry(entries, line_entry(path_classes(line), line.name));
  }
  for (const MapBody& body : map.bodies) {
    if (body.arcs.empty()) continue;
    add_entry(entries, {.drawing = "<ellipse class=\"" + body_classes(body) +
                                   "\" cx=\"14\" cy=\"6\" rx=\"9\" ry=\"4.5\"/>",
                        .name = body.name});
  }
  for (const MapCloud& cloud : map.clouds) {
    add_entry(entries, dot_entry("points " + colour_class(cloud.colour), cloud.name));
  }
  for (const MapEllipse& ellipse : map.ellipses) {
    if (!is_shown(ellipse)) continue;
    add_entry(entries, {.drawing = "<ellipse class=\"outline " + colour_class(ellipse.colour) +
                                   "\" cx=\"14\" cy=\"6\" rx=\"11\" ry=\"4.5\"/>",
                        .name = name_of(ellipse, map.ellipses)});
  }
  for (const MapContours& contours : map.contours) {
    add_entry(entries, line_entry("outline " + colour_class(contours.colour),
                                  name_of(contours, map.contours)));
  }
  for (LegendEntry& entry : mover_entries(map.movers)) add_entry(entries, std::move(entry));
  add_ground_entries(entries, map);
  return entries;
}

std::string map_note(const PlaneMap& map) {
  std::vector<std::string> parts;
  if (!map.note.empty()) parts.push_back(map.note);
  if (const std::vector<double> levels = common_levels(map.ellipses); !levels.empty()) {
    parts.push_back("Ellipses hold " + percentages(levels) + ".");
  }
  if (const std::vector<double> levels = common_levels(map.contours); !levels.empty()) {
    parts.push_back("Lines of equal density hold " + percentages(levels) + ".");
  }
  std::size_t drawn = 0;
  for (const std::vector<MapDot>& dots : dots_of(map)) drawn += dots.size();
  if (const std::size_t all = drawable_dots(map); drawn < all) {
    parts.push_back(fmt::format("Of {} dots, {} are drawn, picked by weight.", all, drawn));
  }
  if (const std::size_t omitted = omitted_values(map); omitted > 0) {
    parts.push_back(fmt::format("{} value{} not finite and not drawn.", omitted,
                                omitted == 1 ? " is" : "s are"));
  }
  return fmt::format("{}", fmt::join(parts, " "));
}

}  // namespace qsmpc::harness
