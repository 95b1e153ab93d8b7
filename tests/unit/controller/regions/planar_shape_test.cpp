// Planar shapes: refusals, the parts that they consist of, and their surfaces, compared with plain
// searches.
#include "controller/regions/planar/planar_shape.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/regions/planar/convex_surface.hpp"
#include "controller/regions/planar/polygon.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "tests/support/shape_truth.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace planar_shape_test {

using namespace testing;
using ::testing::HasSubstr;

Eigen::Matrix2Xd corners_of(std::initializer_list<Eigen::Vector2d> points) {
  Eigen::Matrix2Xd corners(2, static_cast<Eigen::Index>(points.size()));
  Eigen::Index i = 0;
  for (const Eigen::Vector2d& point : points) corners.col(i++) = point;
  return corners;
}

double area_of(const Eigen::Matrix2Xd& corners) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < corners.cols(); ++i) {
    const Eigen::Index next = (i + 1) % corners.cols();
    sum += 0.5 * (corners(0, i) * corners(1, next) - corners(0, next) * corners(1, i));
  }
  return sum;
}

/// A star of `points` points about the origin, without straight angles.
Eigen::Matrix2Xd star(int points, Generator& generator) {
  Eigen::Matrix2Xd corners(2, 2 * points);
  for (int i = 0; i < 2 * points; ++i) {
    const double angle = std::numbers::pi * i / points;
    const double radius = i % 2 == 0 ? uniform(generator, 0.8, 1.4) : uniform(generator, 0.2, 0.5);
    corners.col(i) << radius * std::cos(angle), radius * std::sin(angle);
  }
  return corners;
}

TEST(PlanarShape, refuses_invalid_shapes_and_says_what_is_expected) {
  const double infinite = std::numeric_limits<double>::infinity();
  const auto why = [](const PlanarShape& shape) {
    try {
      check_planar_shape(shape);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(why(DiscShape{.radius = 0.0}), HasSubstr("a radius above 0"));
  EXPECT_THAT(why(DiscShape{.centre = {0, infinite}, .radius = 1}), HasSubstr("a finite centre"));
  EXPECT_THAT(why(EllipseShape{.semi_axes = {1, -1}}), HasSubstr("semi-axes above 0"));
  EXPECT_THAT(why(TurnedBoxShape{.size = {0, 1}}), HasSubstr("sides above 0"));
  EXPECT_THAT(why(HalfPlaneShape{.normal = {0, 0}}), HasSubstr("a length above 0"));
  const auto polygon = [&](std::initializer_list<Eigen::Vector2d> points) {
    return why(PolygonShape{.corners = corners_of(points)});
  };
  EXPECT_THAT(polygon({{0, 0}, {1, 0}}), HasSubstr("at least 3 corners, not 2"));
  EXPECT_THAT(polygon({{0, 0}, {1, 0}, {2, 0}}), HasSubstr("an area above 0"));
  EXPECT_THAT(polygon({{0, 0}, {1, 1}, {1, 0}, {0, 1}}), HasSubstr("from corners 0 and 2 do"));
  EXPECT_THAT(polygon({{0, 0}, {1, 0}, {1, 0}, {0, 1}}), HasSubstr("1 and 2 are the same"));
  // It doubles back on itself.
  EXPECT_THAT(polygon({{0, 0}, {2, 0}, {1, 0}, {1, 1}}), HasSubstr("do not meet"));
  // It touches itself in a corner.
  EXPECT_THAT(polygon({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}), HasSubstr("do not meet"));
  EXPECT_EQ(polygon({{0, 0}, {0, 1}, {1, 0}}), "");          // either orientation
  EXPECT_EQ(polygon({{0, 0}, {1, 0}, {2, 0}, {2, 1}}), "");  // straight angle at a corner
}

TEST(PlanarShape, that_is_convex_is_one_part) {
  EXPECT_EQ(convex_parts(DiscShape{.radius = 1.0}).size(), 1U);
  EXPECT_EQ(convex_parts(TurnedBoxShape{.size = {1, 2}, .angle = 0.3}).size(), 1U);
  EXPECT_EQ(convex_parts(HalfPlaneShape{}).size(), 1U);
  const auto parts =
      convex_parts(PolygonShape{.corners = corners_of({{0, 0}, {0, 2}, {2, 2}, {2, 1}, {2, 0}})});
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].corners.cols(), 4);  // without the corner with a straight angle
}

TEST(PlanarShape, that_is_not_convex_is_covered_by_few_convex_parts) {
  Generator generator(5);
  for (int points = 2; points < 12; ++points) {
    const Eigen::Matrix2Xd corners = star(points, generator);
    const auto pieces = convex_pieces(corners);
    // A star needs one part for every two of its inner corners.
    EXPECT_LE(pieces.size(), 4U * static_cast<std::size_t>(points));
    double area = 0.0;
    for (const Eigen::Matrix2Xd& piece : pieces) {
      EXPECT_GT(area_of(piece), 0.0);
      area += area_of(piece);
      const ConvexPart part = convex_polygon(piece);
      for (Eigen::Index i = 0; i < piece.cols(); ++i) {
        EXPECT_LE((part.normals.transpose() * piece.col(i) - part.offsets).maxCoeff(), 1e-12);
      }
    }
    EXPECT_NEAR(area, area_of(corners), 1e-12);
  }
}

TEST(PlanarShape, is_entered_where_a_plain_search_says) {
  Generator generator(6);
  const std::vector<PlanarShape> shapes = {
      DiscShape{.centre = {0.2, -0.1}, .radius = 0.4},
      EllipseShape{.centre = {0.1, 0.2}, .semi_axes = {0.9, 0.3}, .angle = 0.7},
      TurnedBoxShape{.centre = {-0.2, 0.1}, .size = {1.2, 0.5}, .angle = -0.4},
      PolygonShape{.corners = star(5, generator)},
      HalfPlaneShape{.normal = {1.0, -2.0}, .offset = 0.5}};
  for (const PlanarShape& shape : shapes) {
    SafeSet safe_set = unbounded_safe_set(2);
    safe_set.obstacles = {shape};
    for (const double radius : {0.0, 0.15}) {
      safe_set.body = {.discs = {{.radius = radius}}, .x = 0, .y = 1};
      const UnsafeSet unsafe(safe_set);
      int inside = 0;
      for (int k = 0; k < 2000; ++k) {
        const Eigen::Vector2d point = random_matrix(generator, 2, 1, 1.5);
        const double clear = clearance(point, unsafe);
        // The polygon around an ellipse extends slightly beyond it.
        const double slack = std::holds_alternative<EllipseShape>(shape) ? 1e-3 : 1e-9;
        if (clear > 1e-9) {
          EXPECT_FALSE(is_near(shape, point, radius)) << point.transpose();
        }
        if (clear < -slack) {
          EXPECT_TRUE(is_near(shape, point, radius)) << point.transpose();
        }
        if (clear <= 0.0) ++inside;
      }
      EXPECT_GT(inside, 50);
    }
  }
}

TEST(PlanarShape, that_is_a_half_plane_ends_along_its_normal_whatever_that_rounds_to) {
  Generator generator(8);
  for (int repetition = 0; repetition < 1000; ++repetition) {
    const HalfPlaneShape shape{.normal = random_matrix(generator, 2, 1, 3.0), .offset = 0.7};
    const ConvexPart part = convex_parts(shape).front();
    const Eigen::Vector2d normal = part.normals.col(0);
    EXPECT_NEAR(support(part, normal), part.offsets[0], 1e-12);
    EXPECT_EQ(support(part, -normal), std::numeric_limits<double>::infinity());
    EXPECT_EQ(support(part, {-normal.y(), normal.x()}), std::numeric_limits<double>::infinity());
  }
}

// By a fine search over all directions.
TEST(PlanarSeparation, is_the_best_over_all_directions) {
  Generator generator(7);
  for (int repetition = 0; repetition < 200; ++repetition) {
    ConvexPart part =
        convex_parts(repetition % 3 == 0
                         ? PlanarShape(DiscShape{.centre = {0.1, 0.2}, .radius = 0.3})
                         : PlanarShape(TurnedBoxShape{.size = {0.8, 0.3},
                                                      .angle = uniform(generator, 0.0, 3.0)}))
            .front();
    if (repetition % 2 == 0) part.radius += 0.2;
    const Eigen::Vector2d mean = random_matrix(generator, 2, 1, 1.5);
    const Eigen::Matrix2d root = random_matrix(generator, 2, 2, 0.4);
    const Eigen::Matrix2d covariance = root * root.transpose() + 1e-3 * Eigen::Matrix2d::Identity();
    double best = -std::numeric_limits<double>::infinity();
    for (int k = 0; k < 100000; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / 100000;
      const Eigen::Vector2d n(std::cos(angle), std::sin(angle));
      best = std::max(best, (n.dot(mean) - support(part, n)) / std::sqrt(n.dot(covariance * n)));
    }
    const PlanarSeparation found = separation(part, mean, covariance);
    EXPECT_LE(found.z, best + 1e-4 * (1.0 + std::abs(best)));
    // Inside, the separation that is found need not be the shortest way out.
    if (best > 0.0) {
      EXPECT_NEAR(found.z, best, 1e-4 * (1.0 + best));
    }
    const Eigen::Vector2d n = found.slope.normalized();
    EXPECT_NEAR(found.z, (n.dot(mean) - support(part, n)) / std::sqrt(n.dot(covariance * n)),
                1e-6 * (1.0 + std::abs(found.z)));
  }
}

TEST(PlanarSeparation, from_the_centre_of_a_disc_is_a_way_out) {
  const ConvexPart part = convex_parts(DiscShape{.centre = {0.1, 0.2}, .radius = 0.3}).front();
  Eigen::Matrix2d covariance;
  covariance << 0.04, 0.01, 0.01, 0.02;
  const PlanarSeparation found = separation(part, {0.1, 0.2}, covariance);
  const Eigen::Vector2d n = found.slope.normalized();
  EXPECT_NEAR(n.norm(), 1.0, 1e-12);
  EXPECT_NEAR(found.z, -0.3 / std::sqrt(n.dot(covariance * n)), 1e-9);
}

}  // namespace planar_shape_test
}  // namespace qsmpc::controller
