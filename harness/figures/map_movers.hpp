// Obstacles that move, on a map: the way of each, and its outline at moments of it.
#pragma once

#include <string>
#include <vector>

#include "harness/figures/legend.hpp"
#include "harness/figures/map_canvas.hpp"
#include "harness/figures/map_regions.hpp"

namespace qsmpc::harness {

struct MapMover {
  std::vector<MapPoint> way{};  ///< of its middle
  // Outlines of it; without corners: none.
  MapPolygon start{};
  MapPolygon end{};
  MapPolygon nearest{};  ///< where the vehicle was nearest to it
};

/// All of them. What belongs to the moment of the vehicle's is filled, so that many ways do not
/// hide it.
[[nodiscard]] std::string movers_svg(const MapCanvas& canvas, const std::vector<MapMover>& movers);

/// What the signs mean that `movers` have.
[[nodiscard]] std::vector<LegendEntry> mover_entries(const std::vector<MapMover>& movers);

}  // namespace qsmpc::harness
