// The outside of a road: distances, tails and bounds by the tree of walls, compared with all walls
// in turn, and the walls with the road itself.
#include "controller/regions/planar/road_region.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "controller/reference/road_edges.hpp"
#include "controller/regions/planar/convex_surface.hpp"
#include "controller/regions/unsafe_part.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace road_region_test {

using namespace testing;

/// A circuit of `count` points with bends to both sides, about 100 m long.
ArcPath circuit(int count) {
  Eigen::Matrix2Xd points(2, count);
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    const double radius = 14.0 + 3.0 * std::cos(2.0 * angle) + 1.5 * std::sin(3.0 * angle);
    points.col(i) << radius * std::cos(angle), radius * std::sin(angle);
  }
  return {points, true};
}

RoadWidths widths_of(const ArcPath& path) {
  const Eigen::Index count = path.point_count();
  return {.right = Eigen::VectorXd::LinSpaced(count, 1.5, 2.5),
          .left = Eigen::VectorXd::LinSpaced(count, 2.5, 2.0)};
}

std::shared_ptr<const RoadWalls> walls_of(const ArcPath& path) {
  return std::make_shared<const RoadWalls>(edges_about(path, widths_of(path), 2.0));
}

double width_at(const ArcPath& path, const Eigen::VectorXd& widths, double along) {
  const Eigen::Index count = widths.size();
  for (Eigen::Index i = 0; i < count; ++i) {
    const double from = path.arc_of(i);
    const double to = path.arc_of(i + 1);
    if (along > to) continue;
    const double share = (along - from) / (to - from);
    return (1.0 - share) * widths[i] + share * widths[(i + 1) % count];
  }
  return widths[0];
}

/// Correlated, with standard deviations of about `scale`.
Eigen::MatrixXd random_covariance(Generator& generator, double scale) {
  const Eigen::MatrixXd root = random_matrix(generator, 2, 2, scale);
  return root * root.transpose() + 0.01 * scale * scale * Eigen::MatrixXd::Identity(2, 2);
}

TEST(RoadRegion, is_what_lies_behind_the_edges) {
  const ArcPath path = circuit(60);
  const RoadWidths widths = widths_of(path);
  const RegionPointer region = make_road(walls_of(path), {.radius = 0.0, .x = 0, .y = 1});
  // Chords, and walls that span several points, deviate from the edges by less than this.
  constexpr double kOff = 0.02;
  for (double along = 0.0; along < path.length(); along += 0.13) {
    const PathPlace place = path.at(along);
    const Eigen::Vector2d to_left(-std::sin(place.heading), std::cos(place.heading));
    const double left = width_at(path, widths.left, along);
    const double right = width_at(path, widths.right, along);
    for (const double share : {0.02, 0.5, 1.0}) {
      const Eigen::Vector2d behind_left = place.position + (left + kOff + share) * to_left;
      const Eigen::Vector2d behind_right = place.position - (right + kOff + share) * to_left;
      EXPECT_LE(region->signed_distance(0, behind_left), 0.0) << along << " " << share;
      EXPECT_LE(region->signed_distance(0, behind_right), 0.0) << along << " " << share;
    }
    for (double share = -0.95; share < 1.0; share += 0.19) {
      const double across = share * ((share > 0.0 ? left : right) - kOff);
      EXPECT_GT(region->signed_distance(0, place.position + across * to_left), 0.0)
          << along << " " << across;
    }
  }
}

TEST(RoadRegion, answers_as_all_walls_in_turn) {
  const auto walls = walls_of(circuit(200));
  Generator generator(5);
  for (const double radius : {0.0, 0.8}) {
    const RegionPointer region = make_road(walls, {.radius = radius, .x = 0, .y = 1});
    Points points(2, 400);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      points.col(i) = 20.0 * random_matrix(generator, 2, 1, 1.0);
    }
    Eigen::ArrayXd least = Eigen::ArrayXd::Constant(points.cols(), kInfinity);
    region->lower_to_distances(0, points, least);
    NearestFaces faces{.distance = Eigen::ArrayXd::Constant(points.cols(), kInfinity),
                       .slope = Points::Zero(2, points.cols())};
    region->lower_to_faces(0, points, faces);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const SurfacePoint nearest = nearest_surface(std::span(walls->pieces()), points.col(i));
      EXPECT_NEAR(least[i], nearest.distance - radius, 1e-12);
      EXPECT_NEAR(faces.distance[i], nearest.distance - radius, 1e-12);
      EXPECT_NEAR(faces.slope.col(i).norm(), 1.0, 1e-12);
      EXPECT_NEAR(region->signed_distance(0, points.col(i)), least[i], 1e-12);
    }
  }
}

TEST(RoadRegion, tails_are_those_of_all_walls_with_their_derivatives) {
  const auto walls = walls_of(circuit(200));
  const RegionPointer region = make_road(walls, {.radius = 0.3, .x = 0, .y = 1});
  Generator generator(7);
  const ArcPath path = circuit(200);
  for (int n = 0; n < 30; ++n) {
    Gaussian law{.mean = path.at(uniform(generator, 0.0, path.length())).position,
                 .covariance = random_covariance(generator, 0.5)};
    law.mean += random_matrix(generator, 2, 1, 0.5);
    TailSum sum;
    sum.clear(2);
    region->add_tail(0, law, sum);
    double all = 0.0;
    for (ConvexPart piece : walls->pieces()) {
      piece.radius += 0.3;
      all += extended_tail(separation(piece, law.mean, law.covariance).z);
    }
    EXPECT_NEAR(sum.value(), all, 1e-9 * all);
    constexpr double kStep = 1e-6;
    for (int axis = 0; axis < 2; ++axis) {
      Gaussian moved = law;
      moved.mean[axis] += kStep;
      TailSum more;
      more.clear(2);
      region->add_tail(0, moved, more);
      EXPECT_NEAR((more.value() - sum.value()) / kStep, sum.by_mean()[axis],
                  1e-3 * (1e-9 + sum.by_mean().norm()));
    }
  }
}

TEST(RoadRegion, bound_without_an_error_is_no_less_than_the_truth) {
  const auto walls = walls_of(circuit(200));
  const RegionPointer region = make_road(walls, {.radius = 0.3, .x = 0, .y = 1});
  const ArcPath path = circuit(200);
  Generator generator(11);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 12; ++n) {
    const Eigen::Vector2d mean = path.at(uniform(generator, 0.0, path.length())).position +
                                 random_matrix(generator, 2, 1, 0.6);
    const Eigen::MatrixXd covariance = random_covariance(generator, 0.4);
    const Eigen::MatrixXd root = Eigen::LLT<Eigen::MatrixXd>(covariance).matrixL();
    constexpr int kSamples = 40000;
    int unsafe = 0;
    for (int i = 0; i < kSamples; ++i) {
      const Eigen::Vector2d draw(normal(generator), normal(generator));
      unsafe += region->signed_distance(0, mean + root * draw) <= 0.0 ? 1 : 0;
    }
    const double rate = static_cast<double>(unsafe) / kSamples;
    const double slack = 5.0 * std::sqrt(rate / kSamples) + 1e-9;  // five standard errors of the
                                                                   // rate
    EXPECT_GE(region->soft_probability(0, mean, covariance, 1e-4), rate - slack);
    const Gaussian law{.mean = mean, .covariance = covariance};
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(2);
    HigherNorms higher;
    for (Eigen::VectorXd& norms : higher) norms = none;
    const std::function<Eigen::MatrixXd(const std::vector<Eigen::Index>&)> smoothing =
        [&](const std::vector<Eigen::Index>& /*axes*/) { return covariance; };
    RegionProbability bound;
    region->add_probability(
        0, {.law = law, .error = none, .higher = higher, .smoothing = smoothing}, bound);
    EXPECT_GE(bound.smooth, rate - slack);
    EXPECT_LE(bound.smooth, bound.markov + 1e-12);
  }
}

TEST(RoadWalls, edges_that_meet_are_reported) {
  // A figure of eight.
  Eigen::Matrix2Xd points(2, 40);
  for (int i = 0; i < 40; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 40;
    points.col(i) << 30.0 * std::sin(angle), 15.0 * std::sin(2.0 * angle);
  }
  const ArcPath path(points, true);
  const RoadEdges edges = edges_about(path, widths_of(path), 2.0);
  const auto place = where_edges_meet(edges);
  ASSERT_TRUE(place.has_value());
  EXPECT_LT(place->norm(), 5.0) << "where the eight crosses itself";
  EXPECT_THROW(RoadWalls{edges}, std::invalid_argument);
  EXPECT_FALSE(where_edges_meet(edges_about(circuit(60), widths_of(circuit(60)), 2.0)));
}

TEST(RoadWalls, a_bend_tighter_than_the_width_is_reported) {
  const ArcPath path = circuit(60);
  RoadWidths widths = widths_of(path);
  EXPECT_FALSE(folded_edge(path, widths));
  widths.left.setConstant(30.0);
  const auto folded = folded_edge(path, widths);
  ASSERT_TRUE(folded.has_value());
  EXPECT_LT(folded->radius, 30.0);
}

TEST(RoadWalls, stand_off_another_stretch_of_the_road) {
  // A hairpin with legs 5 m apart and 2 m of road to either side: room for walls of half a metre.
  Eigen::Matrix2Xd points(2, 26);
  for (int i = 0; i < 10; ++i) {
    points.col(i) << 2.0 * i, 0.0;
    points.col(25 - i) << 2.0 * i, 5.0;
  }
  for (int i = 0; i < 6; ++i) {
    const double angle = std::numbers::pi * ((i + 1.0) / 7.0 - 0.5);
    points.col(10 + i) << 18.0 + 1.5 + 2.5 * std::cos(angle), 2.5 + 2.5 * std::sin(angle);
  }
  const ArcPath path(points, false);
  const Eigen::VectorXd width = Eigen::VectorXd::Constant(26, 2.0);
  const RoadWalls walls(edges_about(path, {.right = width, .left = width}, 3.0));
  const auto region =
      make_road(std::make_shared<const RoadWalls>(walls), {.radius = 0.0, .x = 0, .y = 1});
  for (double along = 0.0; along <= path.length(); along += 0.1) {
    EXPECT_GT(region->signed_distance(0, path.at(along).position), 1.9) << along;
  }
  EXPECT_LE(region->signed_distance(0, Eigen::Vector2d(8.0, 2.5)), 0.05) << "between the legs";
}

TEST(UnsafePart, off_the_road_is_out_of_bounds) {
  SafeSet safe_set = unbounded_safe_set(2);
  safe_set.body = {.discs = {}, .x = 0, .y = 1};
  const ArcPath path = circuit(60);
  safe_set.road = walls_of(path);
  const UnsafeSet unsafe(safe_set);
  const PathPlace place = path.at(10.0);
  const Eigen::Vector2d to_left(-std::sin(place.heading), std::cos(place.heading));
  EXPECT_EQ(unsafe_part(place.position, unsafe), UnsafePart::kNone);
  EXPECT_EQ(unsafe_part(place.position + 3.0 * to_left, unsafe), UnsafePart::kBounds);
  EXPECT_TRUE(unsafe.obstacles().empty());
}

}  // namespace road_region_test
}  // namespace qsmpc::controller
