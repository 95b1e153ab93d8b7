// A smooth path in the plane, parametrised by arc length: a cubic spline through given points.
//
//   const ArcPath path(points, true);
//   const PathPlace place = path.at(12.5);          // position, heading, curvature
//   const double along = path.project({x, y}, 10.0, 15.0);
#pragma once

#include <vector>

#include <Eigen/Core>

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// A place on a path.
struct PathPlace {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< m
  double heading = 0.0;                                ///< of the path, rad, from −π to π
  double curvature = 0.0;                              ///< 1/m, positive to the left
};

/// The cubic spline with continuous curvature through the points in order, parametrised by
/// cumulative chord length; natural end conditions for an open path, periodic for a closed one. An
/// open path continues straight beyond its ends; a closed one wraps around.
class ArcPath {
 public:
  /// points: 2 x n in m, no two successive ones equal, nor the last and the first of a closed path.
  /// Throws std::invalid_argument on invalid points, or fewer than 2 of them (3 for a closed path).
  ArcPath(const Eigen::Matrix2Xd& points, bool closed);

  [[nodiscard]] bool closed() const { return closed_; }
  /// Of the whole path, m.
  [[nodiscard]] double length() const { return knots_.back().arc; }
  [[nodiscard]] Eigen::Index point_count() const { return count_; }
  /// The arc length at point i.
  [[nodiscard]] double arc_of(Eigen::Index i) const { return knots_[i].arc; }

  /// The place at arc length `along`, which may lie beyond the ends, or span any number of laps.
  [[nodiscard]] PathPlace at(double along) const;

  /// The arc length between `from` and `to` at which the path is nearest to `point`; on a closed
  /// path, accumulated over laps. from ≤ to; at most one whole lap or path is searched.
  [[nodiscard]] double project(const Eigen::Vector2d& point, double from, double to) const;
  /// The same on the whole path, from 0 to its length.
  [[nodiscard]] double project(const Eigen::Vector2d& point) const;

 private:
  // The start of a segment, by the spline's parameter.
  struct Knot {
    double parameter = 0.0;
    double arc = 0.0;
    Eigen::Vector2d position = Eigen::Vector2d::Zero();
    Eigen::Vector2d bend = Eigen::Vector2d::Zero();  // the second derivative
  };
  struct Derivatives {
    Eigen::Vector2d position;
    Eigen::Vector2d first;
    Eigen::Vector2d second;
  };

  [[nodiscard]] Derivatives derivatives(std::size_t segment, double share) const;
  [[nodiscard]] double arc_within(std::size_t segment, double share) const;
  [[nodiscard]] double share_at(std::size_t segment, double arc) const;
  [[nodiscard]] double refined(const Eigen::Vector2d& point, double along, double from,
                               double to) const;
  void bend(const Eigen::Matrix2Xd& points);

  bool closed_;
  Eigen::Index count_;
  std::vector<Knot> knots_;      // one more than segments
  std::vector<double> sub_arc_;  // of a polyline finer than the points, where projection starts
  Eigen::Matrix2Xd sub_points_;
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
