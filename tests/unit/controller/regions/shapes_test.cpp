// Every shape of the table: distances, penalties and probabilities compared with plain searches and
// simulation.
#include "controller/regions/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "controller/regions/planar/shape_region.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace shapes_test {

using namespace testing;

constexpr int kStage = 3;

/// A three-dimensional box; half of the coordinates are unbounded on one side or both.
Box random_intervals(Generator& generator) {
  Box box{.lower = Eigen::VectorXd(3), .upper = Eigen::VectorXd(3)};
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = uniform(generator, -1.0, 0.2);
    box.upper[axis] = box.lower[axis] + uniform(generator, 0.3, 1.0);
    if (uniform(generator, 0.0, 1.0) < 0.3) box.lower[axis] = -kInfinity;
    if (uniform(generator, 0.0, 1.0) < 0.3) box.upper[axis] = kInfinity;
  }
  // There must be both unsafe and safe points.
  box.lower[0] = std::max(box.lower[0], -1.0);
  return box;
}

Eigen::Vector2d random_place(Generator& generator) {
  return {uniform(generator, -0.6, 0.6), uniform(generator, -0.6, 0.6)};
}

/// One shape of each kind, about as large as the intervals; polygons are convex.
std::vector<std::pair<std::string, PlanarShape>> random_planar_shapes(Generator& generator) {
  PolygonShape polygon{.corners = Eigen::Matrix2Xd(2, 5)};
  const Eigen::Vector2d centre = random_place(generator);
  double angle = uniform(generator, 0.0, 1.0);
  for (int i = 0; i < 5; ++i, angle += uniform(generator, 0.9, 1.3)) {
    polygon.corners.col(i) = centre + 0.5 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  return {
      {"disc",
       DiscShape{.centre = random_place(generator), .radius = uniform(generator, 0.1, 0.6)}},
      {"ellipse",
       EllipseShape{.centre = random_place(generator),
                    .semi_axes = {uniform(generator, 0.1, 0.3), uniform(generator, 0.3, 0.6)},
                    .angle = uniform(generator, -3.0, 3.0)}},
      {"box", TurnedBoxShape{.centre = random_place(generator),
                             .size = {uniform(generator, 0.2, 0.8), uniform(generator, 0.2, 0.8)},
                             .angle = uniform(generator, -3.0, 3.0)}},
      {"polygon", polygon},
      {"half_plane",
       HalfPlaneShape{.normal = random_place(generator), .offset = uniform(generator, -0.3, 0.3)}}};
}

/// An L-shaped polygon.
PlanarShape random_corner(Generator& generator) {
  PolygonShape polygon{.corners = Eigen::Matrix2Xd(2, 6)};
  polygon.corners << 0.0, 0.8, 0.8, 0.3, 0.3, 0.0,  //
      0.0, 0.0, 0.25, 0.25, 0.9, 0.9;
  return moved(polygon, random_place(generator));
}

/// Calls `check` with regions of each shape, some of them grown.
template <class Check>
void for_every_planar_shape(const Check& check, bool convex_alone = false) {
  Generator generator(73);
  for (int repetition = 0; repetition < 20; ++repetition) {
    const Growth growth{.radius = repetition % 2 == 0 ? 0.0 : 0.2, .x = 0, .y = 1};
    for (const auto& [name, shape] : random_planar_shapes(generator)) {
      SCOPED_TRACE(name + " " + std::to_string(repetition));
      check(*make_shape(shape, growth), generator);
    }
    if (convex_alone) continue;
    SCOPED_TRACE("corner " + std::to_string(repetition));
    check(*make_shape(random_corner(generator), growth), generator);
  }
}

/// A rectangle in the plane of the first two of three coordinates.
Box rectangle(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper) {
  return {.lower = Eigen::Vector3d(lower.x(), lower.y(), -kInfinity),
          .upper = Eigen::Vector3d(upper.x(), upper.y(), kInfinity)};
}

/// Calls `check` with rectangles that have round corners, and some with sides but no corners.
template <class Check>
void for_every_grown_rectangle(const Check& check) {
  Generator generator(79);
  for (int repetition = 0; repetition < 40; ++repetition) {
    SCOPED_TRACE("grown rectangle " + std::to_string(repetition));
    const Eigen::Vector2d lower = random_place(generator);
    const Eigen::Vector2d size(uniform(generator, 0.1, 0.8), uniform(generator, 0.1, 0.8));
    Box box = rectangle(lower, lower + size);
    if (repetition % 8 == 0) box.upper[0] = kInfinity;
    const double radius = uniform(generator, 0.05, 0.5);
    check(*make_box(box, {.radius = radius, .x = 0, .y = 1}), generator);
  }
}

template <class Check>
void for_every_shape(const Check& check, bool convex_alone = false) {
  for_every_planar_shape(check, convex_alone);
  Generator generator(71);
  for (const ShapeEntry& entry : region_shapes()) {
    SCOPED_TRACE(entry.name);
    EXPECT_FALSE(entry.summary.empty());
    for (int repetition = 0; repetition < 20; ++repetition) {
      const RegionPointer region = make_region(entry.name, random_intervals(generator));
      check(*region, generator);
    }
  }
}

Eigen::VectorXd standard_normal(Generator& generator) {
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(3, [&] { return normal(generator); });
}

Points random_points_about(Generator& generator, int count) {
  Points points(3, count);
  for (int i = 0; i < count; ++i) points.col(i) = random_matrix(generator, 3, 1, 1.3);
  return points;
}

TEST(Shapes, distances_of_many_points_are_those_of_each) {
  for_every_shape([](const UnsafeRegion& region, Generator& generator) {
    const Points points = random_points_about(generator, 40);
    Eigen::ArrayXd least = Eigen::ArrayXd::Constant(40, kInfinity);
    region.lower_to_distances(kStage, points, least);
    for (int i = 0; i < 40; ++i) {
      EXPECT_NEAR(least[i], region.signed_distance(kStage, points.col(i)), 1e-14);
    }
    // Smaller values stay unchanged.
    Eigen::ArrayXd low = Eigen::ArrayXd::Constant(40, -100.0);
    region.lower_to_distances(kStage, points, low);
    EXPECT_TRUE((low == -100.0).all());
  });
}

/// Whether a point close to `point` is on the other side of the boundary than `safe` says.
bool has_other_side(const UnsafeRegion& region, const Eigen::Vector3d& point, bool safe) {
  constexpr double kAbout = 2e-5;
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < 90; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / 90;
      Eigen::Vector3d moved = point;
      moved[axis] += kAbout * std::cos(angle);
      moved[(axis + 1) % 3] += kAbout * std::sin(angle);
      if ((region.signed_distance(kStage, moved) > 0.0) != safe) return true;
    }
  }
  return false;
}

// The distance is how far one can move without changing sides: a shorter step never does, and a
// step of that length along the gradient ends next to the other side.
TEST(Shapes, distance_is_how_far_the_boundary_is) {
  for_every_shape(
      [](const UnsafeRegion& region, Generator& generator) {
        for (int i = 0; i < 20; ++i) {
          const Eigen::Vector3d point = random_matrix(generator, 3, 1, 1.3);
          const double distance = region.signed_distance(kStage, point);
          for (int k = 0; k < 20; ++k) {
            const Eigen::Vector3d direction = random_matrix(generator, 3, 1).normalized();
            const Eigen::Vector3d moved = point + 0.999 * std::abs(distance) * direction;
            EXPECT_EQ(region.signed_distance(kStage, moved) > 0.0, distance > 0.0);
          }
          Eigen::Vector3d gradient;
          for (int axis = 0; axis < 3; ++axis) {
            constexpr double kStep = 1e-7;
            const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
            gradient[axis] = (region.signed_distance(kStage, point + step) -
                              region.signed_distance(kStage, point - step)) /
                             (2.0 * kStep);
          }
          const Eigen::Vector3d boundary = point - distance * gradient.normalized();
          EXPECT_TRUE(has_other_side(region, boundary, distance > 0.0))
              << point.transpose() << ", at " << distance;
        }
      },
      true);
}

TEST(Shapes, penalty_has_its_gradient_and_falls_with_the_distance) {
  for_every_shape([](const UnsafeRegion& region, Generator& generator) {
    const Points points = random_points_about(generator, 11);
    const Eigen::VectorXd weights = Eigen::VectorXd::LinSpaced(11, 0.2, 1.3);
    const auto value_of = [&](const Points& at, Points& adjoint, ParticleRange range) {
      return region.add_penalty(kStage, {.locations = at,
                                         .weights = weights,
                                         .range = range,
                                         .scale = 7.0,
                                         .length = 0.4,
                                         .adjoint = adjoint});
    };
    Points adjoint = Points::Constant(3, 11, 0.5);
    const double value = value_of(points, adjoint, {2, 9});
    EXPECT_GE(value, 0.0);
    double far = 0.0;
    for (int i = 0; i < 11; ++i) {
      Points unused = Points::Zero(3, 11);
      const double alone = value_of(points, unused, {i, i + 1});
      // h is 0 beyond the length; the walls may count a corner twice.
      if (region.signed_distance(kStage, points.col(i)) >= 0.4) far += alone;
      if (region.signed_distance(kStage, points.col(i)) <= 0.0) {
        EXPECT_GE(alone, 3.5 * weights[i] - 1e-12);
      }
      for (int axis = 0; axis < 3; ++axis) {
        constexpr double kStep = 1e-6;
        Points moved = points;
        moved(axis, i) += kStep;
        const double high = value_of(moved, unused, {2, 9});
        moved(axis, i) -= 2.0 * kStep;
        const double slope = (high - value_of(moved, unused, {2, 9})) / (2.0 * kStep);
        EXPECT_NEAR(adjoint(axis, i) - 0.5, slope, 1e-4 * (1.0 + std::abs(slope)));
      }
    }
    EXPECT_EQ(far, 0.0);
  });
}

Eigen::MatrixXd random_covariance(Generator& generator, bool diagonal) {
  const Eigen::MatrixXd root = random_matrix(generator, 3, 3, 0.3);
  const Eigen::MatrixXd covariance = root * root.transpose();
  if (!diagonal) return covariance;
  return Eigen::MatrixXd(covariance.diagonal().asDiagonal());
}

// E(1 − d²/t²)₊ by simulation, compared with both ways of computing it.
TEST(Shapes, soft_probabilities_are_not_below_the_simulated) {
  constexpr int kSamples = 4000;
  for_every_shape([](const UnsafeRegion& region, Generator& generator) {
    for (const bool diagonal : {true, false}) {
      const Eigen::MatrixXd covariance = random_covariance(generator, diagonal);
      const Eigen::MatrixXd root = covariance.llt().matrixL();
      const Points centres = random_points_about(generator, 5);
      const Eigen::VectorXd lowest = centres.rowwise().minCoeff();
      const Eigen::VectorXd highest = centres.rowwise().maxCoeff();
      const auto soft = region.soften(
          kStage,
          {.centres = centres, .covariance = covariance, .lowest = lowest, .highest = highest});
      for (const double t : {0.05, 0.3, 1.5}) {
        std::vector<double> totals(5, 0.25);
        soft->add(t, 0, 5, totals.data());
        for (int i = 0; i < 5; ++i) {
          const Eigen::Vector3d centre = centres.col(i);
          double sum = 0.0;
          for (int k = 0; k < kSamples; ++k) {
            const Eigen::Vector3d y = centre + root * standard_normal(generator);
            const double distance = std::max(0.0, region.signed_distance(kStage, y));
            sum += std::max(0.0, 1.0 - distance * distance / (t * t));
          }
          const double simulated = sum / kSamples;
          const double allowance = 5.0 * std::sqrt(0.25 / kSamples);
          const double one = region.soft_probability(kStage, centre, covariance, t);
          EXPECT_GE(one, simulated - allowance);
          EXPECT_GE(totals[i] - 0.25, simulated - allowance);
          EXPECT_NEAR(totals[i] - 0.25, one, 1e-8);
        }
      }
    }
  });
}

// The state is y + n + e, where e moves y towards the region as far as it may without knowing n.
TEST(Shapes, probabilities_with_an_error_are_not_below_the_simulated) {
  constexpr int kSamples = 4000;
  static constexpr double kError = 0.05;
  const auto check = [](const UnsafeRegion& region, Generator& generator) {
    const Gaussian law{.mean = random_matrix(generator, 3, 1, 1.2),
                       .covariance = random_covariance(generator, false)};
    const Eigen::VectorXd error = Eigen::VectorXd::Constant(3, kError);
    HigherNorms higher;
    higher.fill(error);
    const Eigen::MatrixXd half = 0.5 * law.covariance;
    const std::function<Eigen::MatrixXd(const std::vector<Eigen::Index>&)> smoothing =
        [&](const std::vector<Eigen::Index>& /*axes*/) { return half; };
    RegionProbability sum{.markov = 0.125, .smooth = 0.125};
    region.add_probability(
        kStage, {.law = law, .error = error, .higher = higher, .smoothing = smoothing}, sum);
    EXPECT_LE(sum.smooth, sum.markov);
    const Eigen::MatrixXd root = half.llt().matrixL();
    int unsafe = 0;
    for (int k = 0; k < kSamples; ++k) {
      const Eigen::Vector3d y = law.mean + root * standard_normal(generator);
      Eigen::Vector3d nearest = y;
      double least = kInfinity;
      for (int corner = 0; corner < 8; ++corner) {
        Eigen::Vector3d moved = y;
        for (int axis = 0; axis < 3; ++axis) {
          moved[axis] += ((corner >> axis) & 1) != 0 ? kError : -kError;
        }
        const double distance = region.signed_distance(kStage, moved);
        if (distance >= least) continue;
        least = distance;
        nearest = moved;
      }
      const Eigen::Vector3d state = nearest + root * standard_normal(generator);
      if (region.signed_distance(kStage, state) <= 0.0) ++unsafe;
    }
    const double simulated = static_cast<double>(unsafe) / kSamples;
    EXPECT_GE(sum.smooth - 0.125, simulated - 5.0 * std::sqrt(0.25 / kSamples));
  };
  for_every_shape(check);
  for_every_grown_rectangle(check);
}

// The tails are smooth surrogates: at least the probability, and with correct derivatives.
TEST(Shapes, tails_hold_the_probability_and_have_their_derivatives) {
  constexpr int kSamples = 4000;
  int inside = 0;
  const auto check = [&](const UnsafeRegion& region, Generator& generator) {
    for (const bool diagonal : {true, false}) {
      Gaussian law{.mean = random_matrix(generator, 3, 1, 1.3),
                   .covariance = random_covariance(generator, diagonal)};
      if (region.signed_distance(kStage, law.mean) <= 0.0) ++inside;
      TailSum sum;
      const auto value_of = [&](const Gaussian& at) {
        TailSum one;
        one.clear(3);
        region.add_tail(kStage, at, one);
        return one.value();
      };
      sum.clear(3);
      region.add_tail(kStage, law, sum);
      constexpr double kStep = 1e-6;
      for (int a = 0; a < 3; ++a) {
        Gaussian moved = law;
        moved.mean[a] += kStep;
        const double high = value_of(moved);
        moved.mean[a] -= 2.0 * kStep;
        const double slope = (high - value_of(moved)) / (2.0 * kStep);
        EXPECT_NEAR(sum.by_mean()[a], slope, 1e-4 * (1.0 + std::abs(slope)));
        for (int b = 0; b < 3; ++b) {
          const double step = 1e-3 * std::sqrt(law.covariance(a, a) * law.covariance(b, b)) * 1e-2;
          moved = law;
          moved.covariance(a, b) += 0.5 * step;
          moved.covariance(b, a) += 0.5 * step;
          const double wide = value_of(moved);
          moved.covariance(a, b) -= step;
          moved.covariance(b, a) -= step;
          const double by_covariance = (wide - value_of(moved)) / (2.0 * step);
          EXPECT_NEAR(sum.by_covariance()(a, b), by_covariance,
                      2e-3 * (1.0 + std::abs(by_covariance)));
        }
      }
      const Eigen::MatrixXd root = law.covariance.llt().matrixL();
      int unsafe = 0;
      for (int k = 0; k < kSamples; ++k) {
        const Eigen::Vector3d state = law.mean + root * standard_normal(generator);
        if (region.signed_distance(kStage, state) <= 0.0) ++unsafe;
      }
      const double simulated = static_cast<double>(unsafe) / kSamples;
      EXPECT_GE(sum.value(), simulated - 5.0 * std::sqrt(0.25 / kSamples));
    }
  };
  for_every_shape(check);
  for_every_grown_rectangle(check);
  EXPECT_GT(inside, 5);
}

TEST(Shapes, tails_grow_with_the_depth_where_probabilities_are_one) {
  const Box block{.lower = Eigen::Vector3d(-1.0, -1.0, -kInfinity),
                  .upper = Eigen::Vector3d(1.0, 1.0, kInfinity)};
  const RegionPointer box = make_region("box", block);
  double last = 0.0;
  for (const double x : {1.05, 1.0, 0.8, 0.4, 0.2}) {
    TailSum sum;
    sum.clear(3);
    box->add_tail(
        kStage,
        {.mean = Eigen::Vector3d(x, 0.0, 0.0), .covariance = 1e-4 * Eigen::Matrix3d::Identity()},
        sum);
    EXPECT_GT(sum.value(), last);
    last = sum.value();
  }
  EXPECT_GT(last, 1e20);
}

TEST(Shapes, answer_what_is_not_a_number_or_unknown) {
  EXPECT_THROW((void)make_region("star", {}), std::invalid_argument);
  for_every_shape([](const UnsafeRegion& region, Generator& /*generator*/) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Gaussian law{.mean = Eigen::Vector3d::Constant(nan),
                       .covariance = Eigen::Matrix3d::Identity()};
    const Eigen::VectorXd error = Eigen::VectorXd::Constant(3, 0.1);
    HigherNorms higher;
    higher.fill(error);
    const std::function<Eigen::MatrixXd(const std::vector<Eigen::Index>&)> smoothing =
        [&](const std::vector<Eigen::Index>& /*axes*/) { return law.covariance; };
    RegionProbability sum;
    region.add_probability(
        kStage, {.law = law, .error = error, .higher = higher, .smoothing = smoothing}, sum);
    EXPECT_GE(sum.smooth, 1.0);
  });
}

TEST(Shapes, outlines_are_the_boundary_in_the_plane) {
  const Box block{.lower = Eigen::Vector3d(1.0, 2.0, -kInfinity),
                  .upper = Eigen::Vector3d(3.0, 5.0, kInfinity)};
  const Outline walls = make_region("walls", block)->outline(kStage, 0, 1);
  EXPECT_FALSE(walls.unsafe_inside);
  EXPECT_EQ(walls.corners.rowwise().minCoeff(), Eigen::Vector2d(1.0, 2.0));
  EXPECT_EQ(walls.corners.rowwise().maxCoeff(), Eigen::Vector2d(3.0, 5.0));
  const Outline box = make_region("box", block)->outline(kStage, 1, 0);
  EXPECT_TRUE(box.unsafe_inside);
  EXPECT_FALSE(box.depends_on_others);
  EXPECT_EQ(box.corners.rowwise().minCoeff(), Eigen::Vector2d(2.0, 1.0));
  const Outline slice = make_region("box", block)->outline(kStage, 0, 2);
  EXPECT_TRUE(slice.depends_on_others);
  EXPECT_EQ(slice.corners(1, 0), -kInfinity);
  // A coordinate that the system lacks.
  EXPECT_EQ(make_region("box", block)->outline(kStage, 0, -1).corners(1, 2), kInfinity);
}

}  // namespace shapes_test
}  // namespace qsmpc::controller
