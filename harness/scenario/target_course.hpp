// From a path as it is written to what controllers follow, and to the walls of its road.
#pragma once

#include <string>

#include "controller/reference/path_target.hpp"
#include "controller/regions/safe_set.hpp"
#include "harness/scenario/path_file.hpp"
#include "harness/scenario/target_path.hpp"

namespace qsmpc::harness {

/// The walls behind a road's edges are this thick, m, or so many periods at its top speed where
/// that is more: nobody gets over them within a period.
inline constexpr double kLeastWallThickness = 2.0;
inline constexpr double kWallPeriods = 2.0;

/// What a course is made for.
struct CourseStart {
  Eigen::Vector2d position;  ///< of the vehicle's mean at first
  double time_step = 0.1;    ///< s
};

/// The path as controllers follow it: from where it is nearest to the start, over its laps or to
/// its end. `path` must be one that check_path_rows takes.
[[nodiscard]] controller::PathTarget course_of(const TargetPath& path, const CourseStart& start);

/// The walls of the road that the path's widths make; null without widths, and where something is
/// wrong, which is noted: edges that fold back in a bend or meet, a road that is narrower than the
/// body.
[[nodiscard]] std::shared_ptr<const controller::RoadWalls> road_of(
    const TargetPath& path, const controller::PathTarget& course, const controller::Body& body,
    const RowNote& note);

/// Places along the whole path for drawing, back to the first where it is closed, 2 x n.
[[nodiscard]] Eigen::Matrix2Xd centre_line(const controller::ArcPath& path);

/// Whether a place is on the road.
[[nodiscard]] bool is_on_road(const controller::RoadWalls& road, const Eigen::Vector2d& place);

}  // namespace qsmpc::harness
