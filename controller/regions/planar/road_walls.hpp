// The outside of a road, as convex walls behind its edges.
//
// A wall is the region behind several successive points of an edge, between the bisectors at the
// first and the last of them, up to a given thickness. It is thinner where another stretch of the
// road is nearer, or where the edge bends too sharply for that thickness. Successive walls share
// their ends, so that there are no gaps (docs/theory/shapes.md, "Roads").
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/planar/convex_surface.hpp"
#include "controller/regions/planar/planar_shape.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// How far a wall that covers several points of an edge may reach into the road, m.
inline constexpr double kEdgeTolerance = 0.01;

/// The edges of a road, in the direction of travel; metres.
struct RoadEdges {
  Eigen::Matrix2Xd left;   ///< 2 x n, n ≥ 2
  Eigen::Matrix2Xd right;  ///< 2 x n
  bool closed = false;     ///< whether each edge continues from its last point to its first
  double thickness = 2.0;  ///< of the walls behind them, > 0
};

/// A point near which an edge meets itself or the other edge; empty if there is none.
[[nodiscard]] std::optional<Eigen::Vector2d> where_edges_meet(const RoadEdges& edges);

class RoadWalls {
 public:
  /// One or several successive walls and a circle about them. The nodes form a tree, so that
  /// distant walls are skipped together.
  struct Node {
    int begin = 0;  ///< index of its first piece …
    int end = 0;    ///< … and one past its last
    Circle circle{};
    // Indices of the child nodes; -1 for a single piece.
    int first = -1;
    int second = -1;
    bool of_one_edge = true;

    [[nodiscard]] bool is_leaf() const { return first < 0; }
  };

  /// Throws std::invalid_argument if edges meet, and on invalid sizes and numbers.
  explicit RoadWalls(RoadEdges edges);

  [[nodiscard]] const RoadEdges& edges() const { return edges_; }
  /// The walls, those behind the left edge first; along each edge in the direction of travel.
  [[nodiscard]] const std::vector<ConvexPart>& pieces() const { return pieces_; }
  /// The tree, the root first.
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  /// The road as a polygon, in either orientation; a closed road is cut at its start.
  [[nodiscard]] Eigen::Matrix2Xd outline() const;

 private:
  int add_node(int begin, int end, int border);

  RoadEdges edges_;
  std::vector<ConvexPart> pieces_;
  std::vector<Node> nodes_;
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
