#include "harness/figures/contour_lines.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace contour_lines_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;

/// Values around a centre, on 21 x 31 nodes.
MatrixXd values_of(double (*function)(double, double)) {
  return MatrixXd::NullaryExpr(21, 31, [&](Index i, Index j) {
    return function(static_cast<double>(i) - 10.0, static_cast<double>(j) - 15.0);
  });
}

TEST(ContourLines, of_a_plane_hill_lie_where_the_level_is) {
  // Linear along every edge, so the interpolation is exact.
  const auto lines =
      contour_lines(values_of([](double x, double y) { return -std::abs(x) - std::abs(y); }), -6.4);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].col(0), lines[0].rightCols(1));
  for (Index n = 0; n < lines[0].cols(); ++n) {
    const Vector2d at = lines[0].col(n) - Vector2d(10, 15);
    EXPECT_NEAR(at.lpNorm<1>(), 6.4, 1e-12);  // rounding
  }
}

TEST(ContourLines, go_round_a_hole_too) {
  const auto lines = contour_lines(
      values_of([](double x, double y) { return -std::abs(std::hypot(x, y) - 5.0); }), -1.6);
  EXPECT_EQ(lines.size(), 2U);
}

TEST(ContourLines, at_a_saddle_the_mean_of_the_corners_decides) {
  MatrixXd values = MatrixXd::Zero(4, 4);
  values(1, 1) = values(2, 2) = 1.0;
  EXPECT_EQ(contour_lines(values, 0.6).size(), 2U);  // the saddle's mean, 0.5, is below
  EXPECT_EQ(contour_lines(values, 0.4).size(), 1U);
  const MatrixXd mirrored = values.rowwise().reverse();
  EXPECT_EQ(contour_lines(mirrored, 0.6).size(), 2U);
  EXPECT_EQ(contour_lines(mirrored, 0.4).size(), 1U);
}

TEST(ContourLines, close_before_the_rim_and_about_values_that_are_not_finite) {
  MatrixXd values = MatrixXd::Constant(9, 9, 5.0);
  values(3, 3) = std::numeric_limits<double>::quiet_NaN();
  values(5, 5) = std::numeric_limits<double>::infinity();
  const auto lines = contour_lines(values, 1.0);
  ASSERT_EQ(lines.size(), 3U);
  for (const auto& line : lines) {
    EXPECT_TRUE(line.allFinite());
    EXPECT_EQ(line.col(0), line.rightCols(1));
  }
}

TEST(ContourLines, a_level_that_is_not_reached_has_no_lines) {
  EXPECT_TRUE(contour_lines(MatrixXd::Ones(5, 5), 2.0).empty());
  EXPECT_TRUE(contour_lines(MatrixXd(0, 0), 0.0).empty());
}

}  // namespace contour_lines_test
}  // namespace qsmpc::harness
