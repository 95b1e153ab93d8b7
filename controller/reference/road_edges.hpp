// The edges of a road around a path, from its widths.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "controller/reference/arc_path.hpp"
#include "controller/regions/planar/road_walls.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// Distances from the centre line to either edge at the points of a path, perpendicular to it, m;
/// linear in arc length in between.
struct RoadWidths {
  Eigen::VectorXd right;  ///< n, > 0
  Eigen::VectorXd left;   ///< n, > 0
};

/// The edges as polylines; each chord deviates from the curve by less than a centimetre. `widths`
/// must have as many points as the path.
[[nodiscard]] RoadEdges edges_about(const ArcPath& path, const RoadWidths& widths,
                                    double thickness);

/// A bend too tight for the road width on its inner side.
struct FoldedEdge {
  Eigen::Index point = 0;  ///< of the path, the last one before the bend
  double radius = 0.0;     ///< of the bend, m
  double width = 0.0;      ///< m
};

/// Where an edge folds back on itself; empty if none does.
[[nodiscard]] std::optional<FoldedEdge> folded_edge(const ArcPath& path, const RoadWidths& widths);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
