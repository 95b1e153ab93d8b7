#include "controller/regions/planar/road_walls.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "controller/regions/planar/polygon.hpp"

namespace qsmpc::controller {
namespace {

// While another stretch of the road is behind a wall, the wall is thinned by this factor,
// repeatedly.
constexpr double kThinner = 0.7;
constexpr int kThinnings = 24;
// Behind a bend the back of a wall keeps at least this fraction of the edge's length.
constexpr double kLeastBack = 0.1;
// A wall for several points of an edge covers at most this many stretches and this turn, rad.
constexpr int kMostPoints = 64;
constexpr double kMostTurn = 1.0;

/// The stretch of an edge between two successive points.
struct Stretch {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  bool is_left;
  Eigen::Index number;  ///< along its edge

  [[nodiscard]] Eigen::Vector2d middle() const { return 0.5 * (from + to); }
  [[nodiscard]] double half_length() const { return 0.5 * (to - from).norm(); }
};

double cross_product(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

std::vector<Stretch> stretches_of(const RoadEdges& edges) {
  std::vector<Stretch> stretches;
  for (const bool is_left : {true, false}) {
    const Eigen::Matrix2Xd& points = is_left ? edges.left : edges.right;
    const Eigen::Index count = points.cols();
    for (Eigen::Index i = 0; i + (edges.closed ? 0 : 1) < count; ++i) {
      stretches.push_back({.from = points.col(i),
                           .to = points.col((i + 1) % count),
                           .is_left = is_left,
                           .number = i});
    }
  }
  return stretches;
}

bool do_meet(const Stretch& one, const Stretch& other) {
  const Eigen::Vector2d a = one.to - one.from;
  const Eigen::Vector2d b = other.to - other.from;
  const auto sides = [](const Eigen::Vector2d& way, const Eigen::Vector2d& from,
                        const Stretch& of) {
    return cross_product(way, of.from - from) * cross_product(way, of.to - from);
  };
  return sides(a, one.from, other) <= 0.0 && sides(b, other.from, one) <= 0.0;
}

/// Whether the stretch enters the part's polygon deeper than `depth`.
bool enters(const ConvexPart& part, const Stretch& stretch, double depth) {
  double from = 0.0;
  double to = 1.0;
  for (Eigen::Index i = 0; i < part.normals.cols(); ++i) {
    const double limit = part.offsets[i] - depth;
    const double start = part.normals.col(i).dot(stretch.from) - limit;
    const double end = part.normals.col(i).dot(stretch.to) - limit;
    if (start > 0.0 && end > 0.0) return false;
    if (start > 0.0) from = std::max(from, start / (start - end));
    if (end > 0.0) to = std::min(to, start / (start - end));
  }
  return from < to;
}

/// The walls behind one edge.
class EdgeWalls {
 public:
  EdgeWalls(const RoadEdges& edges, bool is_left, const std::vector<Stretch>& all)
      : points_(is_left ? edges.left : edges.right),
        is_left_(is_left),
        closed_(edges.closed),
        all_(all) {
    const Eigen::Index count = points_.cols();
    thickness_.setConstant(count, edges.thickness);
    away_.resize(2, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const bool has_last = closed_ || i > 0;
      const bool has_next = closed_ || i + 1 < count;
      Eigen::Vector2d sum = Eigen::Vector2d::Zero();
      if (has_last) sum += outward((i + count - 1) % count);
      if (has_next) sum += outward(i);
      away_.col(i) = sum.norm() > 1e-9 ? Eigen::Vector2d(sum.normalized()) : outward(i);
    }
    make_room();
  }

  [[nodiscard]] Eigen::Index stretches() const {
    return closed_ ? points_.cols() : points_.cols() - 1;
  }

  void add_pieces(std::vector<ConvexPart>& pieces) const {
    for (Eigen::Index begin = 0; begin < stretches();) {
      ConvexPart piece = wall(begin, begin + 1);
      Eigen::Index end = begin + 1;
      while (end < stretches() && end - begin < kMostPoints && turn(begin, end) <= kMostTurn) {
        ConvexPart longer = wall(begin, end + 1);
        if (!may_stand(longer, begin, end + 1)) break;
        piece = std::move(longer);
        ++end;
      }
      pieces.push_back(std::move(piece));
      begin = end;
    }
  }

 private:
  [[nodiscard]] Eigen::Vector2d point(Eigen::Index i) const {
    return points_.col(i % points_.cols());
  }
  [[nodiscard]] Eigen::Vector2d behind(Eigen::Index i) const {
    const Eigen::Index at = i % points_.cols();
    return points_.col(at) + thickness_[at] * away_.col(at);
  }
  /// Unit normal, out of the road, of the stretch that begins at point i.
  [[nodiscard]] Eigen::Vector2d outward(Eigen::Index i) const {
    const Eigen::Vector2d along = (point(i + 1) - point(i)).normalized();
    return is_left_ ? Eigen::Vector2d(-along.y(), along.x())
                    : Eigen::Vector2d(along.y(), -along.x());
  }
  /// Turn of the edge from its stretch `begin` to its stretch `end`, rad.
  [[nodiscard]] double turn(Eigen::Index begin, Eigen::Index end) const {
    const Eigen::Vector2d first = outward(begin);
    const Eigen::Vector2d last = outward(end);
    return std::abs(std::atan2(cross_product(first, last), first.dot(last)));
  }

  /// The wall behind the points begin … end.
  [[nodiscard]] ConvexPart wall(Eigen::Index begin, Eigen::Index end) const {
    Eigen::Matrix2Xd corners(2, 2 * (end - begin + 1));
    for (Eigen::Index i = begin; i <= end; ++i) {
      corners.col(2 * (i - begin)) = point(i);
      corners.col(2 * (i - begin) + 1) = behind(i);
    }
    return convex_hull(corners);
  }

  /// Whether the road enters the wall behind begin … end, other than at the wall's own edge.
  [[nodiscard]] bool is_entered(const ConvexPart& piece, Eigen::Index begin,
                                Eigen::Index end) const {
    const Circle circle = circle_about(piece);
    const Eigen::Index count = stretches();
    return std::ranges::any_of(all_, [&](const Stretch& stretch) {
      const double reach = circle.radius + stretch.half_length();
      if ((stretch.middle() - circle.centre).squaredNorm() > reach * reach) return false;
      if (stretch.is_left == is_left_) {
        // The wall's own stretches and their neighbours do not count.
        Eigen::Index after = stretch.number - begin + 1;
        if (closed_) after = (after + count) % count;
        if (after >= 0 && after <= end - begin + 1) return false;
      }
      return enters(piece, stretch, kEdgeTolerance);
    });
  }

  /// Whether one wall may replace those behind begin … end.
  [[nodiscard]] bool may_stand(const ConvexPart& piece, Eigen::Index begin,
                               Eigen::Index end) const {
    for (Eigen::Index i = begin + 1; i < end; ++i) {
      if (nearest_surface(piece, point(i)).distance < -kEdgeTolerance) return false;
    }
    return !is_entered(piece, begin, end);
  }

  /// Thins walls that would fold back on themselves or that the road enters.
  void make_room() {
    std::vector<bool> is_good(static_cast<std::size_t>(stretches()), false);
    for (int n = 0; n < kThinnings; ++n) {
      bool all_good = true;
      for (Eigen::Index i = 0; i < stretches(); ++i) {
        if (is_good[i]) continue;
        const Eigen::Vector2d along = point(i + 1) - point(i);
        const bool has_back =
            (behind(i + 1) - behind(i)).dot(along) > kLeastBack * along.squaredNorm();
        is_good[i] = has_back && !is_entered(wall(i, i + 1), i, i + 1);
        if (is_good[i]) continue;
        all_good = false;
        const Eigen::Index next = (i + 1) % points_.cols();
        thickness_[i] *= kThinner;
        thickness_[next] *= kThinner;
        // The neighbours have changed as well.
        const Eigen::Index count = stretches();
        if (closed_ || i > 0) is_good[(i + count - 1) % count] = false;
        if (closed_ || i + 1 < count) is_good[(i + 1) % count] = false;
      }
      if (all_good) return;
    }
  }

  const Eigen::Matrix2Xd& points_;
  bool is_left_;
  bool closed_;
  const std::vector<Stretch>& all_;
  Eigen::VectorXd thickness_;  // by point
  Eigen::Matrix2Xd away_;      // unit vectors
};

void check_edges(const RoadEdges& edges) {
  const auto require = [](bool holds, const char* expected) {
    if (!holds) throw std::invalid_argument(expected);
  };
  require(edges.left.cols() == edges.right.cols() && edges.left.cols() >= (edges.closed ? 3 : 2),
          "road: edges with equally many points, at least 2, or 3 if it is closed");
  require(edges.left.allFinite() && edges.right.allFinite(), "road: finite edges");
  require(edges.thickness > 0.0 && std::isfinite(edges.thickness), "road: a thickness above 0");
}

}  // namespace

std::optional<Eigen::Vector2d> where_edges_meet(const RoadEdges& edges) {
  const std::vector<Stretch> stretches = stretches_of(edges);
  const Eigen::Index count = edges.closed ? edges.left.cols() : edges.left.cols() - 1;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const Stretch& one = stretches[i];
    for (std::size_t k = i + 1; k < stretches.size(); ++k) {
      const Stretch& other = stretches[k];
      const double reach = one.half_length() + other.half_length();
      if ((one.middle() - other.middle()).squaredNorm() > reach * reach) continue;
      if (one.is_left == other.is_left) {
        const Eigen::Index apart = other.number - one.number;
        if (apart == 1 || (edges.closed && apart == count - 1)) continue;
      }
      if (!do_meet(one, other)) continue;
      return one.middle();
    }
  }
  return std::nullopt;
}

RoadWalls::RoadWalls(RoadEdges edges) : edges_(std::move(edges)) {
  check_edges(edges_);
  if (where_edges_meet(edges_)) throw std::invalid_argument("road: edges that do not meet");
  const std::vector<Stretch> all = stretches_of(edges_);
  EdgeWalls(edges_, true, all).add_pieces(pieces_);
  const int border = static_cast<int>(pieces_.size());
  EdgeWalls(edges_, false, all).add_pieces(pieces_);
  add_node(0, static_cast<int>(pieces_.size()), border);
}

/// Adds the node of pieces begin … end − 1 and its descendants; returns its index. `border`: the
/// first piece of the other edge.
int RoadWalls::add_node(int begin, int end, int border) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Eigen::Vector2d lowest = pieces_[begin].corners.rowwise().minCoeff();
  Eigen::Vector2d highest = pieces_[begin].corners.rowwise().maxCoeff();
  for (int i = begin + 1; i < end; ++i) {
    lowest = lowest.cwiseMin(pieces_[i].corners.rowwise().minCoeff());
    highest = highest.cwiseMax(pieces_[i].corners.rowwise().maxCoeff());
  }
  Node node{.begin = begin, .end = end};
  node.circle.centre = 0.5 * (lowest + highest);
  for (int i = begin; i < end; ++i) {
    const auto corners = pieces_[i].corners.colwise() - node.circle.centre;
    node.circle.radius = std::max(node.circle.radius, corners.colwise().norm().maxCoeff());
  }
  node.of_one_edge = border <= begin || border >= end;
  if (end - begin > 1) {
    const int middle = node.of_one_edge ? begin + (end - begin) / 2 : border;
    node.first = add_node(begin, middle, border);
    node.second = add_node(middle, end, border);
  }
  nodes_[index] = node;
  return index;
}

Eigen::Matrix2Xd RoadWalls::outline() const {
  const Eigen::Index count = edges_.left.cols();
  const Eigen::Index each = edges_.closed ? count + 1 : count;
  Eigen::Matrix2Xd corners(2, 2 * each);
  for (Eigen::Index i = 0; i < each; ++i) {
    corners.col(i) = edges_.left.col(i % count);
    corners.col(2 * each - 1 - i) = edges_.right.col(i % count);
  }
  return corners;
}

}  // namespace qsmpc::controller
