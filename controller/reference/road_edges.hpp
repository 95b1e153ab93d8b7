// The edges of a road about a path, from its widths.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "controller/reference/arc_path.hpp"
#include "controller/regions/planar/road_walls.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// From the centre line to either edge at the points of a path, across it, m; linear in between by
/// the arc length.
struct RoadWidths {
  Eigen::VectorXd right;  ///< n, > 0
  Eigen::VectorXd left;   ///< n, > 0
};

/// The edges; each chord of theirs is off the curve by less than a centimetre. `widths` must be of
/// as many points as the path.
[[nodiscard]] RoadEdges edges_about(const ArcPath& path, const RoadWidths& widths,
                                    double thickness);

/// A bend that is too tight for the width on its inner side.
struct FoldedEdge {
  Eigen::Index point = 0;  ///< of the path, the one before
  double radius = 0.0;     ///< of the bend, m
  double width = 0.0;      ///< m
};

/// Where an edge turns back on itself; nothing where none does.
[[nodiscard]] std::optional<FoldedEdge> folded_edge(const ArcPath& path, const RoadWidths& widths);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
