#include "controller/reference/arc_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace qsmpc::controller {
namespace {

// Chords per segment of the polyline that projection starts from.
constexpr int kChords = 4;
constexpr int kArcSteps = 4;

double across_ways(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Gauss-Legendre nodes and weights on [0, 1]: exact up to degree 9.
constexpr std::array<std::pair<double, double>, 5> kGauss = {{
    {0.046910077030668004, 0.11846344252809454},
    {0.23076534494715845, 0.23931433524968324},
    {0.5, 0.28444444444444444},
    {0.76923465505284155, 0.23931433524968324},
    {0.953089922969332, 0.11846344252809454},
}};

/// Solves a tridiagonal system (below, diagonal, above; n rows) for two columns, by elimination.
Eigen::MatrixX2d solve_tridiagonal(const Eigen::VectorXd& below, Eigen::VectorXd diagonal,
                                   const Eigen::VectorXd& above, Eigen::MatrixX2d right) {
  const Eigen::Index n = diagonal.size();
  for (Eigen::Index i = 1; i < n; ++i) {
    const double factor = below[i] / diagonal[i - 1];
    diagonal[i] -= factor * above[i - 1];
    right.row(i) -= factor * right.row(i - 1);
  }
  right.row(n - 1) /= diagonal[n - 1];
  for (Eigen::Index i = n - 2; i >= 0; --i) {
    right.row(i) = (right.row(i) - above[i] * right.row(i + 1)) / diagonal[i];
  }
  return right;
}

void demand(bool holds, const char* expected) {
  if (!holds) throw std::invalid_argument(expected);
}

}  // namespace

ArcPath::ArcPath(const Eigen::Matrix2Xd& points, bool closed)
    : closed_(closed), count_(points.cols()) {
  demand(points.allFinite(), "path: finite points");
  demand(count_ >= (closed ? 3 : 2), "path: at least 2 points, or 3 if it is closed");
  const Eigen::Index segments = closed ? count_ : count_ - 1;
  knots_.resize(static_cast<std::size_t>(segments) + 1);
  for (Eigen::Index i = 0; i <= segments; ++i) {
    Knot& knot = knots_[i];
    knot.position = points.col(i % count_);
    if (i == 0) continue;
    const double chord = (knot.position - knots_[i - 1].position).norm();
    demand(chord > 0.0, "path: consecutive points that differ");
    knot.parameter = knots_[i - 1].parameter + chord;
  }
  bend(points);
  sub_points_.resize(2, segments * kChords + 1);
  sub_points_.col(0) = knots_.front().position;
  sub_arc_.push_back(0.0);
  for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
    knots_[i + 1].arc = knots_[i].arc + arc_within(i, 1.0);
    for (int k = 1; k <= kChords; ++k) {
      const double share = static_cast<double>(k) / kChords;
      sub_points_.col(std::ssize(sub_arc_)) = derivatives(i, share).position;
      sub_arc_.push_back(knots_[i].arc + arc_within(i, share));
    }
  }
}

/// Second derivatives at the knots: those that make the first ones continuous.
void ArcPath::bend(const Eigen::Matrix2Xd& points) {
  const auto chord = [&](Eigen::Index i) { return knots_[i + 1].parameter - knots_[i].parameter; };
  const auto slope = [&](Eigen::Index i) -> Eigen::Vector2d {
    return (knots_[i + 1].position - knots_[i].position) / chord(i);
  };
  const Eigen::Index segments = std::ssize(knots_) - 1;
  const Eigen::Index n = closed_ ? count_ : count_ - 2;
  if (n <= 0) return;
  Eigen::VectorXd below(n);
  Eigen::VectorXd diagonal(n);
  Eigen::VectorXd above(n);
  Eigen::MatrixX2d right(n, 2);
  for (Eigen::Index row = 0; row < n; ++row) {
    const Eigen::Index next = closed_ ? row : row + 1;  // the segment after the knot
    const Eigen::Index last = (next + segments - 1) % segments;
    below[row] = chord(last);
    above[row] = chord(next);
    diagonal[row] = 2.0 * (chord(last) + chord(next));
    right.row(row) = 6.0 * (slope(next) - slope(last)).transpose();
  }
  Eigen::MatrixX2d bends;
  if (!closed_) {
    bends = solve_tridiagonal(below, diagonal, above, right);
    for (Eigen::Index row = 0; row < n; ++row) knots_[row + 1].bend = bends.row(row).transpose();
    return;
  }
  // The corners of the cyclic matrix as a rank-1 update (Sherman and Morrison).
  const double corner = below[0];
  const double pivot = -diagonal[0];
  Eigen::VectorXd changed = diagonal;
  changed[0] -= pivot;
  changed[n - 1] -= corner * corner / pivot;
  Eigen::MatrixX2d spike = Eigen::MatrixX2d::Zero(n, 2);
  spike(0, 0) = pivot;
  spike(n - 1, 0) = corner;
  bends = solve_tridiagonal(below, changed, above, right);
  const Eigen::VectorXd answer = solve_tridiagonal(below, changed, above, spike).col(0);
  const double scale = 1.0 + answer[0] + corner / pivot * answer[n - 1];
  const Eigen::RowVector2d share = (bends.row(0) + corner / pivot * bends.row(n - 1)) / scale;
  bends -= answer * share;
  for (Eigen::Index i = 0; i <= n; ++i) knots_[i].bend = bends.row(i % points.cols()).transpose();
}

ArcPath::Derivatives ArcPath::derivatives(std::size_t segment, double share) const {
  const Knot& a = knots_[segment];
  const Knot& b = knots_[segment + 1];
  const double h = b.parameter - a.parameter;
  const double v = share;
  const double u = 1.0 - v;
  Derivatives at;
  at.position = u * a.position + v * b.position +
                h * h / 6.0 * ((u * u * u - u) * a.bend + (v * v * v - v) * b.bend);
  at.first = (b.position - a.position) / h +
             h / 6.0 * ((1.0 - 3.0 * u * u) * a.bend + (3.0 * v * v - 1.0) * b.bend);
  at.second = u * a.bend + v * b.bend;
  return at;
}

/// The arc length from the segment's beginning to this share of its parameter.
double ArcPath::arc_within(std::size_t segment, double share) const {
  const double h = knots_[segment + 1].parameter - knots_[segment].parameter;
  double sum = 0.0;
  for (const auto& [node, weight] : kGauss) {
    sum += weight * derivatives(segment, share * node).first.norm();
  }
  return sum * share * h;
}

/// The share of the parameter at which the segment has this arc length, by Newton's method.
double ArcPath::share_at(std::size_t segment, double arc) const {
  const double whole = knots_[segment + 1].arc - knots_[segment].arc;
  const double h = knots_[segment + 1].parameter - knots_[segment].parameter;
  double share = std::clamp(arc / whole, 0.0, 1.0);
  for (int step = 0; step < kArcSteps; ++step) {
    const double speed = derivatives(segment, share).first.norm() * h;
    if (!(speed > 0.0)) break;
    const double move = (arc - arc_within(segment, share)) / speed;
    share = std::clamp(share + move, 0.0, 1.0);
    if (std::abs(move) < 1e-14) break;
  }
  return share;
}

PathPlace ArcPath::at(double along) const {
  const double whole = length();
  double beyond = 0.0;
  if (closed_) {
    along -= whole * std::floor(along / whole);
  } else {
    beyond = along - std::clamp(along, 0.0, whole);
    along -= beyond;
  }
  const auto after =
      std::upper_bound(knots_.begin() + 1, knots_.end() - 1, along,
                       [](double value, const Knot& knot) { return value < knot.arc; });
  const auto segment = static_cast<std::size_t>(after - knots_.begin()) - 1;
  const Derivatives on = derivatives(segment, share_at(segment, along - knots_[segment].arc));
  const double speed = on.first.norm();
  PathPlace place{.position = on.position,
                  .heading = std::atan2(on.first.y(), on.first.x()),
                  .curvature = across_ways(on.first, on.second) / (speed * speed * speed)};
  if (beyond != 0.0) {
    place.position += beyond / speed * on.first;
    place.curvature = 0.0;
  }
  return place;
}

/// Newton's method from a nearby start: to where the line to the point is perpendicular to the
/// path.
double ArcPath::refined(const Eigen::Vector2d& point, double along, double from, double to) const {
  for (int step = 0; step < kArcSteps; ++step) {
    const PathPlace place = at(along);
    const Eigen::Vector2d way = point - place.position;
    const Eigen::Vector2d ahead(std::cos(place.heading), std::sin(place.heading));
    // Half of the squared distance has the second derivative 1 − κ n·way.
    const double curvature = 1.0 - place.curvature * across_ways(ahead, way);
    const double move = way.dot(ahead) / std::max(curvature, 0.2);
    along = std::clamp(along + move, from, to);
    if (std::abs(move) < 1e-12) break;
  }
  return along;
}

double ArcPath::project(const Eigen::Vector2d& point, double from, double to) const {
  const double whole = length();
  const auto chords = static_cast<Eigen::Index>(sub_arc_.size()) - 1;
  if (!closed_) {
    from = std::clamp(from, 0.0, whole);
    to = std::clamp(to, from, whole);
  }
  double round = closed_ ? whole * std::floor(from / whole) : 0.0;
  const auto first = std::upper_bound(sub_arc_.begin() + 1, sub_arc_.end() - 1, from - round);
  Eigen::Index chord = first - sub_arc_.begin() - 1;
  double best = from;
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index searched = 0; searched <= chords; ++searched) {
    const double begin = sub_arc_[chord];
    const double span = sub_arc_[chord + 1] - begin;
    if (round + begin > to) break;
    const Eigen::Vector2d start = sub_points_.col(chord);
    const Eigen::Vector2d way = sub_points_.col(chord + 1) - start;
    // The part of the chord within the search range.
    const double least_share = std::clamp((from - round - begin) / span, 0.0, 1.0);
    const double most_share = std::clamp((to - round - begin) / span, least_share, 1.0);
    const double share =
        std::clamp((point - start).dot(way) / way.squaredNorm(), least_share, most_share);
    const double along = std::clamp(round + begin + share * span, from, to);
    const double distance = (start + share * way - point).squaredNorm();
    if (distance < least) {
      least = distance;
      best = along;
    }
    if (++chord == chords) {
      if (!closed_) break;
      chord = 0;
      round += whole;
    }
  }
  return refined(point, best, from, to);
}

double ArcPath::project(const Eigen::Vector2d& point) const {
  return project(point, 0.0, length());
}

}  // namespace qsmpc::controller
