#include "controller/regions/planar/polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

namespace qsmpc::controller {
namespace {

// Threshold of twice the area, relative to the square of a polygon's size: less is rounding or an
// unintended polygon.
constexpr double kLeastArea = 1e-9;

using Corner = Eigen::Vector2d;
/// Indices of corners, counterclockwise.
using Loop = std::vector<Eigen::Index>;

/// Twice the area of the triangle; positive if it turns left.
double turn(const Corner& a, const Corner& b, const Corner& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

double twice_area(const Eigen::Matrix2Xd& corners) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < corners.cols(); ++i) {
    const Eigen::Index next = (i + 1) % corners.cols();
    sum += corners(0, i) * corners(1, next) - corners(0, next) * corners(1, i);
  }
  return sum;
}

bool within_box_of(const Corner& point, const Corner& a, const Corner& b) {
  return (point.array() >= a.cwiseMin(b).array()).all() &&
         (point.array() <= a.cwiseMax(b).array()).all();
}

/// Whether two closed segments have a point in common.
bool meet(const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
  const double c_side = turn(a, b, c);
  const double d_side = turn(a, b, d);
  const double a_side = turn(c, d, a);
  const double b_side = turn(c, d, b);
  if (((c_side > 0.0) != (d_side > 0.0)) && ((a_side > 0.0) != (b_side > 0.0)) && c_side != 0.0 &&
      d_side != 0.0 && a_side != 0.0 && b_side != 0.0) {
    return true;
  }
  return (c_side == 0.0 && within_box_of(c, a, b)) || (d_side == 0.0 && within_box_of(d, a, b)) ||
         (a_side == 0.0 && within_box_of(a, c, d)) || (b_side == 0.0 && within_box_of(b, c, d));
}

/// Whether the edges from corners i and j, i < j, meet where neighbours should not.
bool edges_meet(const Eigen::Matrix2Xd& corners, Eigen::Index i, Eigen::Index j) {
  const Eigen::Index count = corners.cols();
  const Corner a = corners.col(i);
  const Corner b = corners.col((i + 1) % count);
  const Corner c = corners.col(j);
  const Corner d = corners.col((j + 1) % count);
  if (j == i + 1) return turn(a, b, d) == 0.0 && (b - a).dot(d - b) < 0.0;  // folds back on itself
  if ((j + 1) % count == i) return turn(c, a, b) == 0.0 && (a - c).dot(b - a) < 0.0;
  return meet(a, b, c, d);
}

/// Whether all corners are on one line, up to triangles of twice the area `area`.
bool is_flat(const Eigen::Matrix2Xd& corners, double area) {
  Eigen::Index far = 0;
  (corners.colwise() - corners.col(0)).colwise().squaredNorm().maxCoeff(&far);
  for (const auto& corner : corners.colwise()) {
    if (std::abs(turn(corners.col(0), corners.col(far), corner)) > area) return false;
  }
  return true;
}

bool in_triangle(const Corner& point, const std::array<Corner, 3>& triangle) {
  return turn(triangle[0], triangle[1], point) >= 0.0 &&
         turn(triangle[1], triangle[2], point) >= 0.0 &&
         turn(triangle[2], triangle[0], point) >= 0.0;
}

/// Whether the corner `at` of the rest of the polygon can be cut off.
bool is_ear(const Eigen::Matrix2Xd& corners, const Loop& left, std::size_t at) {
  const std::size_t count = left.size();
  const std::array<Eigen::Index, 3> ear = {left[(at + count - 1) % count], left[at],
                                           left[(at + 1) % count]};
  const std::array<Corner, 3> triangle = {corners.col(ear[0]), corners.col(ear[1]),
                                          corners.col(ear[2])};
  if (!(turn(triangle[0], triangle[1], triangle[2]) > 0.0)) return false;
  return std::none_of(left.begin(), left.end(), [&](Eigen::Index other) {
    if (std::ranges::find(ear, other) != ear.end()) return false;
    return in_triangle(corners.col(other), triangle);
  });
}

std::vector<Loop> triangles_of(const Eigen::Matrix2Xd& corners) {
  Loop left(static_cast<std::size_t>(corners.cols()));
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = static_cast<Eigen::Index>(i);
  std::vector<Loop> triangles;
  std::size_t at = 0;
  std::size_t tried = 0;
  while (left.size() > 3 && tried < left.size()) {
    const std::size_t count = left.size();
    at %= count;
    // A corner without a turn has no ear to cut off; it is only removed.
    const Corner here = corners.col(left[at]);
    const bool straight = turn(corners.col(left[(at + count - 1) % count]), here,
                               corners.col(left[(at + 1) % count])) == 0.0;
    if (!straight && !is_ear(corners, left, at)) {
      ++at;
      ++tried;
      continue;
    }
    if (!straight) {
      triangles.push_back({left[(at + count - 1) % count], left[at], left[(at + 1) % count]});
    }
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
    tried = 0;
  }
  triangles.push_back(left);
  return triangles;
}

bool is_convex(const Eigen::Matrix2Xd& corners, const Loop& loop) {
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Corner a = corners.col(loop[i]);
    const Corner b = corners.col(loop[(i + 1) % loop.size()]);
    const Corner c = corners.col(loop[(i + 2) % loop.size()]);
    if (turn(a, b, c) < 0.0) return false;
  }
  return true;
}

/// The two loops as one, if they share an edge and are convex together.
std::optional<Loop> joined(const Eigen::Matrix2Xd& corners, const Loop& one, const Loop& two) {
  for (std::size_t i = 0; i < one.size(); ++i) {
    const Eigen::Index from = one[i];
    const Eigen::Index to = one[(i + 1) % one.size()];
    for (std::size_t j = 0; j < two.size(); ++j) {
      if (two[j] != to || two[(j + 1) % two.size()] != from) continue;
      Loop both;
      for (std::size_t k = 0; k < one.size(); ++k) {
        both.push_back(one[(i + 1 + k) % one.size()]);
      }
      for (std::size_t k = 2; k < two.size(); ++k) both.push_back(two[(j + k) % two.size()]);
      if (is_convex(corners, both)) return both;
    }
  }
  return std::nullopt;
}

}  // namespace

std::string why_no_polygon(const Eigen::Matrix2Xd& corners) {
  const Eigen::Index count = corners.cols();
  if (count < 3) return "at least 3 corners, not " + std::to_string(count);
  if (!corners.allFinite()) return "finite corners";
  for (Eigen::Index i = 0; i < count; ++i) {
    if (corners.col(i) == corners.col((i + 1) % count)) {
      return "corners that differ; " + std::to_string(i) + " and " +
             std::to_string((i + 1) % count) + " are the same";
    }
  }
  const double size = (corners.rowwise().maxCoeff() - corners.rowwise().minCoeff()).squaredNorm();
  if (is_flat(corners, kLeastArea * size)) return "an area above 0";
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = i + 1; j < count; ++j) {
      if (edges_meet(corners, i, j)) {
        return "edges that do not meet; those from corners " + std::to_string(i) + " and " +
               std::to_string(j) + " do";
      }
    }
  }
  const double area = std::abs(twice_area(corners));
  if (area <= kLeastArea * size) return "an area above 0";
  double of_pieces = 0.0;
  for (const Eigen::Matrix2Xd& piece : convex_pieces(corners)) of_pieces += twice_area(piece);
  // The polygon is so close to meeting itself that rounding decides.
  if (std::abs(of_pieces - area) > kLeastArea * size) return "edges that are farther apart";
  return "";
}

Eigen::Matrix2Xd counterclockwise(const Eigen::Matrix2Xd& corners) {
  if (twice_area(corners) >= 0.0) return corners;
  return corners.rowwise().reverse();
}

ConvexPart convex_polygon(const Eigen::Matrix2Xd& corners) {
  std::vector<Corner> kept;
  const Eigen::Index count = corners.cols();
  for (Eigen::Index i = 0; i < count; ++i) {
    const Corner before = corners.col((i + count - 1) % count);
    const Corner here = corners.col(i);
    if (turn(before, here, corners.col((i + 1) % count)) > 0.0) kept.push_back(here);
  }
  const auto sides = static_cast<Eigen::Index>(kept.size());
  ConvexPart part{.corners = Eigen::Matrix2Xd(2, sides),
                  .normals = Eigen::Matrix2Xd(2, sides),
                  .offsets = Eigen::VectorXd(sides)};
  for (Eigen::Index i = 0; i < sides; ++i) {
    const Corner from = kept[static_cast<std::size_t>(i)];
    const Corner along = kept[static_cast<std::size_t>((i + 1) % sides)] - from;
    part.corners.col(i) = from;
    part.normals.col(i) = Corner(along.y(), -along.x()).normalized();
    part.offsets[i] = part.normals.col(i).dot(from);
  }
  return part;
}

ConvexPart convex_hull(const Eigen::Matrix2Xd& points) {
  std::vector<Corner> sorted;
  for (const auto& point : points.colwise()) sorted.emplace_back(point);
  const auto before = [](const Corner& a, const Corner& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  };
  std::sort(sorted.begin(), sorted.end(), before);
  std::vector<Corner> chain;
  // The lower chain from left to right, then the upper chain back.
  for (const bool upper : {false, true}) {
    const std::size_t start = chain.size();
    for (const Corner& point : sorted) {
      while (chain.size() >= start + 2 &&
             turn(chain[chain.size() - 2], chain.back(), point) <= 0.0) {
        chain.pop_back();
      }
      chain.push_back(point);
    }
    chain.pop_back();  // the other chain begins with it
    if (!upper) std::reverse(sorted.begin(), sorted.end());
  }
  Eigen::Matrix2Xd corners(2, static_cast<Eigen::Index>(chain.size()));
  for (std::size_t i = 0; i < chain.size(); ++i) {
    corners.col(static_cast<Eigen::Index>(i)) = chain[i];
  }
  return convex_polygon(corners);
}

std::vector<Eigen::Matrix2Xd> convex_pieces(const Eigen::Matrix2Xd& corners) {
  const Eigen::Matrix2Xd turned = counterclockwise(corners);
  std::vector<Loop> loops;
  Loop whole(static_cast<std::size_t>(turned.cols()));
  for (std::size_t i = 0; i < whole.size(); ++i) whole[i] = static_cast<Eigen::Index>(i);
  loops = is_convex(turned, whole) ? std::vector<Loop>{whole} : triangles_of(turned);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    for (std::size_t j = i + 1; j < loops.size();) {
      const std::optional<Loop> both = joined(turned, loops[i], loops[j]);
      if (!both) {
        ++j;
        continue;
      }
      loops[i] = *both;
      loops.erase(loops.begin() + static_cast<std::ptrdiff_t>(j));
      j = i + 1;  // earlier rejections may fit the larger loop
    }
  }
  std::vector<Eigen::Matrix2Xd> pieces;
  pieces.reserve(loops.size());
  for (const Loop& loop : loops) pieces.emplace_back(turned(Eigen::all, loop));
  return pieces;
}

}  // namespace qsmpc::controller
