#include "harness/figures/map_movers.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "harness/figures/map_shapes.hpp"

namespace qsmpc::harness {
namespace {

// Classes of the page's style, all in the colour of moving obstacles.
constexpr std::string_view kWay = "way faint c0";
constexpr std::string_view kStart = "outline thin c0";
constexpr std::string_view kEnd = "outline thin broken c0";
constexpr std::string_view kNearest = "mover c0";

constexpr std::size_t kMostWayPoints = 6000;  // of all paths together; more would not be visible

std::string outlines_svg(const MapCanvas& canvas, const std::vector<MapMover>& movers,
                         MapPolygon MapMover::*outline, std::string_view classes) {
  std::string svg;
  for (const MapMover& mover : movers) {
    const std::vector<MapPoint>& corners = (mover.*outline).corners;
    if (corners.empty()) continue;
    const std::string path = polygon_svg(canvas, corners, std::string(classes));
    if (!path.empty()) svg += path + "\n";
  }
  return svg;
}

bool any(const std::vector<MapMover>& movers, MapPolygon MapMover::*outline) {
  return std::any_of(movers.begin(), movers.end(), [outline](const MapMover& mover) {
    return !(mover.*outline).corners.empty();
  });
}

LegendEntry round_entry(std::string_view classes, const std::string& name) {
  return {.drawing = "<ellipse class=\"" + std::string(classes) +
                     "\" cx=\"14\" cy=\"6\" rx=\"8\" ry=\"4.5\"/>",
          .name = name};
}

}  // namespace

std::string movers_svg(const MapCanvas& canvas, const std::vector<MapMover>& movers) {
  std::size_t points = 0;
  for (const MapMover& mover : movers) points += mover.way.size();
  const std::size_t stride = 1 + points / kMostWayPoints;
  std::string svg;
  for (const MapMover& mover : movers) {
    const std::string data = polyline_data(canvas, mover.way, stride);
    if (data.empty()) continue;
    svg += "<path class=\"" + std::string(kWay) + "\" d=\"" + data + "\"/>\n";
  }
  return svg + outlines_svg(canvas, movers, &MapMover::start, kStart) +
         outlines_svg(canvas, movers, &MapMover::end, kEnd) +
         outlines_svg(canvas, movers, &MapMover::nearest, kNearest);
}

std::vector<LegendEntry> mover_entries(const std::vector<MapMover>& movers) {
  std::vector<LegendEntry> entries;
  if (any(movers, &MapMover::nearest)) {
    entries.push_back(round_entry(kNearest, "moving obstacle when closest to the vehicle"));
  }
  if (std::any_of(movers.begin(), movers.end(),
                  [](const MapMover& mover) { return mover.way.size() > 1; })) {
    entries.push_back(line_entry(std::string(kWay), "path of its centre"));
  }
  if (any(movers, &MapMover::start)) {
    entries.push_back(round_entry(kStart, "moving obstacle at the start"));
  }
  if (any(movers, &MapMover::end)) entries.push_back(round_entry(kEnd, "at the end"));
  return entries;
}

}  // namespace qsmpc::harness
