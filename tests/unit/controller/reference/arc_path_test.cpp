#include "controller/reference/arc_path.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace qsmpc::controller {
namespace arc_path_test {

constexpr double kRadius = 10.0;

Eigen::Matrix2Xd circle_points(int count) {
  Eigen::Matrix2Xd points(2, count);
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    points.col(i) << kRadius * std::cos(angle), kRadius * std::sin(angle);
  }
  return points;
}

TEST(ArcPath, through_points_of_a_circle_is_about_the_circle) {
  const ArcPath path(circle_points(24), true);
  EXPECT_NEAR(path.length(), 2.0 * std::numbers::pi * kRadius, 1e-3);
  for (double along = 0.0; along < path.length(); along += 0.37) {
    const PathPlace place = path.at(along);
    // The error of a cubic spline is of fourth order in the spacing: 2e-5 here.
    EXPECT_NEAR(place.position.norm(), kRadius, 2e-4);
    EXPECT_NEAR(place.curvature, 1.0 / kRadius, 2e-3);
    const Eigen::Vector2d ahead(std::cos(place.heading), std::sin(place.heading));
    EXPECT_NEAR(ahead.dot(place.position) / kRadius, 0.0, 1e-3);
  }
}

TEST(ArcPath, passes_through_its_points_at_their_arc_lengths) {
  Eigen::Matrix2Xd points(2, 5);
  points << 0.0, 3.0, 7.0, 8.0, 12.0,  //
      0.0, 1.0, -1.0, 4.0, 5.0;
  const ArcPath path(points, false);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    EXPECT_LT((path.at(path.arc_of(i)).position - points.col(i)).norm(), 1e-9) << i;
  }
}

TEST(ArcPath, arc_lengths_are_lengths_along_it) {
  Eigen::Matrix2Xd points(2, 5);
  points << 0.0, 3.0, 7.0, 8.0, 12.0,  //
      0.0, 1.0, -1.0, 4.0, 5.0;
  const ArcPath path(points, false);
  constexpr int kChords = 20000;
  double sum = 0.0;
  for (int i = 0; i < kChords; ++i) {
    const double from = path.length() * i / kChords;
    const double to = path.length() * (i + 1) / kChords;
    sum += (path.at(to).position - path.at(from).position).norm();
  }
  // Five Gauss points per segment; the speed is not a polynomial.
  EXPECT_NEAR(sum, path.length(), 1e-3 * path.length());
}

TEST(ArcPath, goes_round_where_it_is_closed_and_straight_on_where_it_is_open) {
  const ArcPath closed(circle_points(24), true);
  EXPECT_LT((closed.at(3.0).position - closed.at(3.0 + 2.0 * closed.length()).position).norm(),
            1e-9);
  EXPECT_LT((closed.at(-1.0).position - closed.at(closed.length() - 1.0).position).norm(), 1e-9);
  Eigen::Matrix2Xd line(2, 2);
  line << 0.0, 4.0, 0.0, 0.0;
  const ArcPath open(line, false);
  EXPECT_LT((open.at(6.0).position - Eigen::Vector2d(6.0, 0.0)).norm(), 1e-12);
  EXPECT_LT((open.at(-2.0).position - Eigen::Vector2d(-2.0, 0.0)).norm(), 1e-12);
}

TEST(ArcPath, projects_to_the_nearest_place_of_the_part_that_is_searched) {
  const ArcPath path(circle_points(24), true);
  const double quarter = 0.25 * path.length();
  EXPECT_NEAR(path.project({0.0, 13.0}), quarter, 1e-3);
  EXPECT_NEAR(
      path.project({0.0, 13.0}, quarter + path.length() - 2.0, quarter + path.length() + 2.0),
      quarter + path.length(), 1e-3);
  EXPECT_NEAR(path.project({0.0, 13.0}, 0.0, 5.0), 5.0, 1e-9) << "the end of what is searched";
  EXPECT_NEAR(path.project({9.0, -0.5}, -3.0, 3.0), -kRadius * std::atan(0.5 / 9.0), 1e-2);
}

TEST(ArcPath, near_its_last_place_is_not_taken_to_another_stretch) {
  // A figure of eight: the two diagonals cross in the middle.
  Eigen::Matrix2Xd points(2, 16);
  for (int i = 0; i < 16; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 16;
    points.col(i) << 10.0 * std::sin(angle), 5.0 * std::sin(2.0 * angle);
  }
  const ArcPath path(points, true);
  double along = 0.0;
  double last = -1.0;
  for (double truth = 0.0; truth < path.length(); truth += 0.4) {
    along = path.project(path.at(truth).position, along - 2.0, along + 2.0);
    EXPECT_NEAR(along, truth, 1e-6);
    EXPECT_GT(along, last);
    last = along;
  }
}

TEST(ArcPath, refuses_what_makes_no_path) {
  EXPECT_THROW(ArcPath(Eigen::Matrix2Xd::Zero(2, 1), false), std::invalid_argument);
  EXPECT_THROW(ArcPath(Eigen::Matrix2Xd::Zero(2, 4), false), std::invalid_argument);
  EXPECT_THROW(ArcPath(circle_points(2), true), std::invalid_argument);
}

}  // namespace arc_path_test
}  // namespace qsmpc::controller
