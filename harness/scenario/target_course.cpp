#include "harness/scenario/target_course.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "controller/reference/road_edges.hpp"
#include "controller/regions/planar/road_walls.hpp"

namespace qsmpc::harness {
namespace {

/// A lower bound on the body's reach to either side, m.
double half_width(const controller::Body& body) {
  double most = 0.0;
  for (const controller::Disc& disc : body.discs) most = std::max(most, disc.radius);
  return most;
}

/// The row nearest to a point.
Eigen::Index nearest_row(const Eigen::MatrixXd& rows, const Eigen::Vector2d& place) {
  Eigen::Index nearest = 0;
  (rows.leftCols<2>().rowwise() - place.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
  return nearest;
}

/// Whether a point is in a triangle or on its border, up to rounding.
bool is_in_triangle(const Eigen::Vector2d& place, const Eigen::Vector2d& a,
                    const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  constexpr double kRounding = 1e-9;
  const auto area = [](const Eigen::Vector2d& one, const Eigen::Vector2d& two,
                       const Eigen::Vector2d& three) {
    return (two.x() - one.x()) * (three.y() - one.y()) -
           (two.y() - one.y()) * (three.x() - one.x());
  };
  const double all = area(a, b, c);
  const double least =
      std::min({area(a, b, place) / all, area(b, c, place) / all, area(c, a, place) / all});
  return least >= -kRounding;
}

}  // namespace

controller::PathTarget course_of(const TargetPath& path, const CourseStart& start) {
  const Eigen::Matrix2Xd points = path.rows.leftCols<2>().transpose();
  controller::PathTarget course{
      .path = std::make_shared<const controller::ArcPath>(points, path.closed),
      .time_step = start.time_step};
  course.speed = path.fast ? controller::SpeedProfile(*course.path, path.limits)
                           : controller::SpeedProfile(path.speed);
  course.begin = course.path->project(start.position);
  course.end = course.path->length();
  if (path.closed) course.end = course.begin + path.laps * course.path->length();
  return course;
}

std::shared_ptr<const controller::RoadWalls> road_of(const TargetPath& path,
                                                     const controller::PathTarget& course,
                                                     const controller::Body& body,
                                                     const RowNote& note) {
  if (!path.has_widths()) return nullptr;
  const controller::RoadWidths widths{.right = path.rows.col(2), .left = path.rows.col(3)};
  Eigen::Index narrowest = 0;
  const double width = (widths.right + widths.left).minCoeff(&narrowest);
  const double needed = 2.0 * half_width(body);
  if (width <= needed) {
    note(narrowest, fmt::format("a road that is {:.3g} m wide", width),
         fmt::format("more than the {:.3g} m of the vehicle's body", needed));
    return nullptr;
  }
  if (const auto folded = controller::folded_edge(*course.path, widths)) {
    note(folded->point,
         fmt::format("a width of {:.3g} m on the inner side of a bend", folded->width),
         fmt::format("less than the bend's radius, {:.3g} m", folded->radius));
    return nullptr;
  }
  const double thickness =
      std::max(kLeastWallThickness, kWallPeriods * course.speed.top() * course.time_step);
  controller::RoadEdges edges = controller::edges_about(*course.path, widths, thickness);
  if (const auto place = controller::where_edges_meet(edges)) {
    note(nearest_row(path.rows, *place),
         fmt::format("edges that meet near ({:.4g}, {:.4g})", place->x(), place->y()),
         "a road whose stretches do not cross one another or themselves, or no widths");
    return nullptr;
  }
  return std::make_shared<const controller::RoadWalls>(std::move(edges));
}

Eigen::Matrix2Xd centre_line(const controller::ArcPath& path) {
  constexpr double kSpacing = 0.5;  // m
  constexpr double kMost = 3000.0;
  const double count = std::clamp(std::ceil(path.length() / kSpacing), 2.0, kMost);
  Eigen::Matrix2Xd points(2, static_cast<Eigen::Index>(count) + 1);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    points.col(i) = path.at(path.length() * static_cast<double>(i) / count).position;
  }
  return points;
}

bool is_on_road(const controller::RoadWalls& road, const Eigen::Vector2d& place) {
  const controller::RoadEdges& edges = road.edges();
  const Eigen::Index count = edges.left.cols();
  for (Eigen::Index i = 0; i + (edges.closed ? 0 : 1) < count; ++i) {
    const Eigen::Index next = (i + 1) % count;
    const bool is_between =
        is_in_triangle(place, edges.left.col(i), edges.right.col(i), edges.right.col(next)) ||
        is_in_triangle(place, edges.left.col(i), edges.right.col(next), edges.left.col(next));
    if (is_between) return true;
  }
  return false;
}

}  // namespace qsmpc::harness
