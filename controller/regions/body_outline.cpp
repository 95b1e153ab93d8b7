#include "controller/regions/body_outline.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

namespace qsmpc::controller {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kLeastArc = 1e-9;  // rad: shorter ones are rounding

using Interval = std::pair<double, double>;

/// Adds the angles of `disc` that lie in `other`, as intervals within [0, 2π]. Of two identical
/// discs, the first in the list is visible.
void add_hidden(const Disc& disc, const Disc& other, bool other_first,
                std::vector<Interval>& hidden) {
  const Eigen::Vector2d way = other.offset - disc.offset;
  const double distance = way.norm();
  if (distance + disc.radius <= other.radius) {
    const bool same = distance == 0.0 && disc.radius == other.radius;
    if (!same || other_first) hidden.emplace_back(0.0, kTurn);
    return;
  }
  if (distance >= disc.radius + other.radius || distance + other.radius <= disc.radius) return;
  const double cosine =
      (distance * distance + disc.radius * disc.radius - other.radius * other.radius) /
      (2.0 * distance * disc.radius);
  const double half = std::acos(std::clamp(cosine, -1.0, 1.0));
  double begin = std::atan2(way.y(), way.x()) - half;
  if (begin < 0.0) begin += kTurn;
  const double end = begin + 2.0 * half;
  hidden.emplace_back(begin, std::min(end, kTurn));
  if (end > kTurn) hidden.emplace_back(0.0, end - kTurn);
}

/// The rest of [0, 2π].
std::vector<Interval> seen_between(std::vector<Interval> hidden) {
  std::sort(hidden.begin(), hidden.end());
  std::vector<Interval> seen;
  double reached = 0.0;
  for (const auto& [begin, end] : hidden) {
    if (begin > reached + kLeastArc) seen.emplace_back(reached, begin);
    reached = std::max(reached, end);
  }
  if (reached < kTurn - kLeastArc) seen.emplace_back(reached, kTurn);
  // Join the two arcs that meet at 2π.
  if (seen.size() > 1 && seen.front().first == 0.0 && seen.back().second == kTurn) {
    seen.back().second += seen.front().second;
    seen.erase(seen.begin());
  }
  return seen;
}

}  // namespace

std::vector<Arc> body_outline(const Body& body, const Eigen::Vector2d& position, double heading) {
  const Eigen::Rotation2Dd turn(heading);
  std::vector<Arc> arcs;
  for (std::size_t i = 0; i < body.discs.size(); ++i) {
    const Disc& disc = body.discs[i];
    std::vector<Interval> hidden;
    for (std::size_t j = 0; j < body.discs.size(); ++j) {
      if (j != i) add_hidden(disc, body.discs[j], j < i, hidden);
    }
    const Eigen::Vector2d centre = position + turn * disc.offset;
    for (const auto& [from, to] : seen_between(std::move(hidden))) {
      arcs.push_back(
          {.centre = centre, .radius = disc.radius, .from = from + heading, .to = to + heading});
    }
  }
  return arcs;
}

}  // namespace qsmpc::controller
