// Converts a path as written into the course that controllers follow and the walls of its road.
#pragma once

#include <string>

#include "controller/reference/path_target.hpp"
#include "controller/regions/safe_set.hpp"
#include "harness/scenario/path_file.hpp"
#include "harness/scenario/target_path.hpp"

namespace qsmpc::harness {

/// The walls behind a road's edges are kLeastWallThickness (m) thick, or kWallPeriods periods at
/// its top speed where that is more: no vehicle crosses them within a period.
inline constexpr double kLeastWallThickness = 2.0;
inline constexpr double kWallPeriods = 2.0;

/// The conditions that a course starts from.
struct CourseStart {
  Eigen::Vector2d position;  ///< of the vehicle's mean, initially
  double time_step = 0.1;    ///< s
};

/// The path as controllers follow it: from the point nearest to the start, over its laps or to its
/// end. `path` must be valid according to check_path_rows.
[[nodiscard]] controller::PathTarget course_of(const TargetPath& path, const CourseStart& start);

/// The walls of the road given by the path's widths; null without widths. Null too, with a noted
/// problem, for edges that fold back in a bend or meet, and for a road narrower than the body.
[[nodiscard]] std::shared_ptr<const controller::RoadWalls> road_of(
    const TargetPath& path, const controller::PathTarget& course, const controller::Body& body,
    const RowNote& note);

/// Points along the whole path for drawing, back to the first where it is closed, 2 x n.
[[nodiscard]] Eigen::Matrix2Xd centre_line(const controller::ArcPath& path);

/// Whether a point is on the road.
[[nodiscard]] bool is_on_road(const controller::RoadWalls& road, const Eigen::Vector2d& place);

}  // namespace qsmpc::harness
