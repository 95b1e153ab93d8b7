// What is outside of a road, as convex walls behind its edges.
//
// A wall is what lies behind some points of an edge, between the bisectors at the first and the
// last of them, up to a thickness; where another stretch of the road is nearer, or the edge bends
// more than that would leave room for, it is thinner. Walls in a row share their ends, so that
// nothing gets between them (docs/theory/shapes.md, "Roads").
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/planar/convex_surface.hpp"
#include "controller/regions/planar/planar_shape.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// How far a wall may reach into the road where it stands for several points of an edge, m.
inline constexpr double kEdgeTolerance = 0.01;

/// The edges of a road, in the direction of travel; metres.
struct RoadEdges {
  Eigen::Matrix2Xd left;   ///< 2 x n, n ≥ 2
  Eigen::Matrix2Xd right;  ///< 2 x n
  bool closed = false;     ///< whether each goes on from its last point to its first
  double thickness = 2.0;  ///< of the walls behind them, > 0
};

/// A place near which an edge meets itself or the other one; nothing where they do not.
[[nodiscard]] std::optional<Eigen::Vector2d> where_edges_meet(const RoadEdges& edges);

class RoadWalls {
 public:
  /// Some walls in a row, and a circle about them: a tree, so that those that are far away are
  /// passed over together.
  struct Node {
    int begin = 0;  ///< of the pieces that it stands for …
    int end = 0;    ///< … and one past the last
    Circle circle{};
    // Indices of nodes; -1 where it is one piece.
    int first = -1;
    int second = -1;
    bool of_one_edge = true;

    [[nodiscard]] bool is_leaf() const { return first < 0; }
  };

  /// Throws std::invalid_argument where edges meet, and on sizes and numbers that make no sense.
  explicit RoadWalls(RoadEdges edges);

  [[nodiscard]] const RoadEdges& edges() const { return edges_; }
  /// Those behind the left edge first, each in the direction of travel.
  [[nodiscard]] const std::vector<ConvexPart>& pieces() const { return pieces_; }
  /// The root first.
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  /// The road as a polygon, counterclockwise or not; of a closed one, cut at its beginning.
  [[nodiscard]] Eigen::Matrix2Xd outline() const;

 private:
  int add_node(int begin, int end, int border);

  RoadEdges edges_;
  std::vector<ConvexPart> pieces_;
  std::vector<Node> nodes_;
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
