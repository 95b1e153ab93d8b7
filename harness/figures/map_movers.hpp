// Moving obstacles on a map: the path of each, and its outline at some moments.
#pragma once

#include <string>
#include <vector>

#include "harness/figures/legend.hpp"
#include "harness/figures/map_canvas.hpp"
#include "harness/figures/map_regions.hpp"

namespace qsmpc::harness {

struct MapMover {
  std::vector<MapPoint> way{};  ///< of its centre
  // Its outlines; not drawn if without corners.
  MapPolygon start{};
  MapPolygon end{};
  MapPolygon nearest{};  ///< at the moment when the vehicle was nearest
};

/// All of `movers` as SVG elements. The outline of the moment when the vehicle was nearest is
/// filled, so that many paths do not hide it.
[[nodiscard]] std::string movers_svg(const MapCanvas& canvas, const std::vector<MapMover>& movers);

/// Legend entries for the signs of `movers`.
[[nodiscard]] std::vector<LegendEntry> mover_entries(const std::vector<MapMover>& movers);

}  // namespace qsmpc::harness
