#include "harness/figures/density.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace density_test {

using Eigen::Index;
using Eigen::Matrix2Xd;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

const VectorXd kEqual{};  // weights

VectorXd vector_of(std::initializer_list<double> values) {
  return Eigen::Map<const VectorXd>(values.begin(), std::ssize(values));
}

/// A banana shape: non-Gaussian, correlated, with coordinates of different scales.
Matrix2Xd example_points(Index count, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Matrix2Xd points(2, count);
  for (Index i = 0; i < count; ++i) {
    const double x = normal(random);
    points.col(i) = Vector2d(4.0 + x, 0.1 * (0.5 * x * x + 0.3 * x + 0.4 * normal(random)));
  }
  return points;
}

VectorXd example_weights(Index count, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0.0, 2.0);
  return VectorXd::NullaryExpr(count, [&] { return uniform(random); });
}

/// Scott's kernel of a weighted sample, in its plainest form.
struct PlainKernel {
  PlainKernel(const MatrixXd& points, const VectorXd& weights)
      : sample(points), share(weights / weights.sum()) {
    const VectorXd mean = sample * share;
    covariance = MatrixXd::Zero(sample.rows(), sample.rows());
    for (Index i = 0; i < sample.cols(); ++i) {
      const VectorXd d = sample.col(i) - mean;
      covariance += share[i] * d * d.transpose() / (1.0 - share.squaredNorm());
    }
    const double factor =
        std::pow(share.squaredNorm(), 1.0 / (static_cast<double>(sample.rows()) + 4.0));
    covariance *= factor * factor;
  }

  [[nodiscard]] double density(const VectorXd& at) const {
    const MatrixXd precision = covariance.inverse();
    const double norm = std::sqrt((2.0 * std::numbers::pi * covariance).determinant());
    double sum = 0.0;
    for (Index i = 0; i < sample.cols(); ++i) {
      const VectorXd d = at - sample.col(i);
      sum += share[i] * std::exp(-0.5 * d.dot(precision * d)) / norm;
    }
    return sum;
  }

  MatrixXd sample;
  VectorXd share;
  MatrixXd covariance;
};

Vector2d node(const DensityGrid& grid, Index i, Index j) {
  return grid.centre + grid.basis * Vector2d(grid.u[i], grid.v[j]);
}

/// Whether an odd number of the lines encloses `point`.
bool is_enclosed(const std::vector<DensityContour>& contours, const Vector2d& point) {
  bool enclosed = false;
  for (const DensityContour& contour : contours) {
    for (Index n = 0; n + 1 < contour.points.cols(); ++n) {
      const Vector2d a = contour.points.col(n);
      const Vector2d b = contour.points.col(n + 1);
      if ((a.y() > point.y()) == (b.y() > point.y())) continue;
      const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      if (point.x() < x) enclosed = !enclosed;
    }
  }
  return enclosed;
}

TEST(EffectiveSize, counts_equal_points_and_leaves_out_those_without_weight) {
  EXPECT_DOUBLE_EQ(effective_size(VectorXd::Constant(7, 3.0)), 7.0);
  EXPECT_DOUBLE_EQ(effective_size(vector_of({1, 0, 1, 0})), 2.0);
  EXPECT_DOUBLE_EQ(effective_size(vector_of({3, 1})), 1.6);
}

TEST(KernelDensity, of_two_points_is_what_the_formula_says) {
  // S = 2 for −1 and 1, n = 2, h² S = 2^(−2/5) · 2; both kernels are one unit away from 0.
  const double variance = 2.0 * std::pow(2.0, -0.4);
  const VectorXd density = kernel_density(vector_of({-1, 1}), kEqual, vector_of({0}));
  const double expected = std::exp(-0.5 / variance) / std::sqrt(2.0 * std::numbers::pi * variance);
  EXPECT_NEAR(density[0], expected, 1e-14);  // rounding
}

TEST(KernelDensity, is_the_sum_of_weighted_kernels) {
  std::mt19937_64 random(3);
  const Index count = 5000;  // more than one block
  const VectorXd sample = example_points(count, random).row(1);
  const VectorXd weights = example_weights(count, random);
  const PlainKernel plain(sample.transpose(), weights);
  const VectorXd at = VectorXd::LinSpaced(9, -0.3, 0.5);
  const VectorXd density = kernel_density(sample, weights, at);
  for (Index i = 0; i < at.size(); ++i) {
    EXPECT_NEAR(density[i], plain.density(at.segment(i, 1)), 1e-11);  // rounding of some 10
  }
}

TEST(DensityCurve, integrates_to_one) {
  std::mt19937_64 random(5);
  const VectorXd sample = example_points(300, random).row(1);
  const DensityCurve curve = density_curve(sample, example_weights(300, random));
  double mass = 0.0;
  for (std::size_t i = 1; i < curve.x.size(); ++i) {
    mass += 0.5 * (curve.x[i] - curve.x[i - 1]) * (curve.density[i] + curve.density[i - 1]);
  }
  EXPECT_NEAR(mass, 1.0, 1e-4);  // 6e-5 of an outermost kernel lies beyond 4 deviations
}

TEST(DensityCurve, scales_and_shifts_with_the_sample) {
  const VectorXd sample = vector_of({0, 1, 3, 4, 9});
  const DensityCurve one = density_curve(sample, kEqual);
  const DensityCurve other = density_curve((100.0 + 1e-3 * sample.array()).matrix(), kEqual);
  for (std::size_t i = 0; i < one.x.size(); ++i) {
    EXPECT_NEAR(other.x[i], 100.0 + 1e-3 * one.x[i], 1e-12);    // rounding at 100
    EXPECT_NEAR(other.density[i], 1e3 * one.density[i], 1e-6);  // the same, of 1e-3
  }
}

TEST(DensityGrid, is_the_sum_of_weighted_kernels) {
  std::mt19937_64 random(7);
  const Matrix2Xd points = example_points(400, random);
  const VectorXd weights = example_weights(400, random);
  const PlainKernel plain(points, weights);
  const DensityGrid grid = density_grid(points, weights, 40);
  const double peak = grid.density.maxCoeff();
  for (Index i = 0; i < 40; i += 3) {
    for (Index j = 0; j < 40; j += 3) {
      EXPECT_NEAR(grid.density(i, j), plain.density(node(grid, i, j)), 1e-11 * peak);  // rounding
    }
  }
}

TEST(DensityGrid, integrates_to_one) {
  std::mt19937_64 random(9);
  const DensityGrid grid = density_grid(example_points(300, random), kEqual);
  EXPECT_NEAR(grid.density.sum() * grid.cell_area(), 1.0, 1e-4);  // minus what lies beyond
}

TEST(DensityGrid, points_on_a_line_or_in_one_place_have_a_density) {
  Matrix2Xd line(2, 50);
  line.row(0).setLinSpaced(0.0, 3.0);
  line.row(1).setLinSpaced(1.0, -5.0);
  const Matrix2Xd place = Vector2d(1e3, 2.0).replicate(1, 5);
  for (const Matrix2Xd& points : {line, place, Matrix2Xd(Vector2d::Zero())}) {
    const DensityGrid grid = density_grid(points, kEqual);
    EXPECT_TRUE(grid.density.allFinite());
    EXPECT_NEAR(grid.density.sum() * grid.cell_area(), 1.0, 1e-3);
    const auto contours = density_contours(grid, {0.9});
    ASSERT_EQ(contours.size(), 1U);
    // Within the points' bounding box plus a kernel around it.
    EXPECT_LT((contours[0].points.col(0) - points.rowwise().mean()).norm(),
              1.5 * (points.colwise() - points.rowwise().mean()).norm() + 1e-6);
  }
}

TEST(DensityContours, of_one_kernel_are_its_confidence_ellipses) {
  // So few points that a single kernel dominates the density: two pairs about 0.
  Matrix2Xd points(2, 4);
  points << -1, 1, 0, 0, 0, 0, -1, 1;
  const PlainKernel plain(points, VectorXd::Ones(4));
  const DensityGrid grid = density_grid(points, kEqual, 400);
  for (const DensityContour& contour : density_contours(grid, {0.25, 0.5, 0.95})) {
    const double level = plain.density(contour.points.col(0));
    for (Index n = 0; n < contour.points.cols(); ++n) {
      // The error of linear interpolation over a cell of 1/40 deviation is (1/40)²/8 of the
      // curvature.
      EXPECT_NEAR(plain.density(contour.points.col(n)), level, 2e-3 * level);
    }
  }
}

TEST(DensityContours, enclose_the_stated_mass) {
  std::mt19937_64 random(11);
  const Matrix2Xd points = example_points(500, random);
  const VectorXd weights = example_weights(500, random);
  const DensityGrid grid = density_grid(points, weights);
  const PlainKernel plain(points, weights);
  const Eigen::Matrix2d root = plain.covariance.llt().matrixL();
  std::discrete_distribution<Index> pick(weights.begin(), weights.end());
  std::normal_distribution<double> normal;
  constexpr int kDraws = 4000;
  for (const double mass : {0.25, 0.5, 0.75, 0.95}) {
    const auto contours = density_contours(grid, {mass});
    int held = 0;
    for (int n = 0; n < kDraws; ++n) {
      const Vector2d noise(normal(random), normal(random));
      if (is_enclosed(contours, points.col(pick(random)) + root * noise)) ++held;
    }
    // Four standard deviations of the count, and the grid's error.
    const double deviation = std::sqrt(mass * (1.0 - mass) / kDraws);
    EXPECT_NEAR(static_cast<double>(held) / kDraws, mass, 4.0 * deviation + 2e-3);
  }
}

TEST(DensityContours, are_closed_and_one_for_each_part) {
  Matrix2Xd points(2, 40);
  for (Index i = 0; i < 40; ++i) {
    const double angle = 0.7 * static_cast<double>(i);
    points.col(i) =
        Vector2d(i < 20 ? -10.0 : 10.0, 0.0) + Vector2d(std::cos(angle), std::sin(angle));
  }
  const auto contours = density_contours(density_grid(points, kEqual), {0.5});
  EXPECT_EQ(contours.size(), 2U);
  for (const DensityContour& contour : contours) {
    EXPECT_EQ(contour.mass, 0.5);
    EXPECT_EQ(contour.points.col(0), contour.points.rightCols(1));
    EXPECT_GT(contour.points.cols(), 10);
  }
}

TEST(DensityContours, nearly_all_of_the_mass_still_has_a_closed_line) {
  const DensityGrid grid = density_grid(Matrix2Xd(Vector2d(1.0, 2.0)), kEqual, 16);
  const auto contours = density_contours(grid, {1.0 - 1e-12});
  ASSERT_EQ(contours.size(), 1U);
  EXPECT_TRUE(contours[0].points.allFinite());
}

TEST(Density, refuses_invalid_samples) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)density_curve(VectorXd(), kEqual), std::invalid_argument);
  EXPECT_THROW((void)density_curve(vector_of({1, nan}), kEqual), std::invalid_argument);
  EXPECT_THROW((void)density_curve(vector_of({1, 2}), vector_of({1})), std::invalid_argument);
  EXPECT_THROW((void)density_curve(vector_of({1, 2}), vector_of({1, -1})), std::invalid_argument);
  EXPECT_THROW((void)density_curve(vector_of({1, 2}), vector_of({0, 0})), std::invalid_argument);
  EXPECT_THROW((void)density_curve(vector_of({1, 2}), kEqual, 1), std::invalid_argument);
  EXPECT_THROW((void)density_grid(Matrix2Xd(2, 0), kEqual), std::invalid_argument);
  const DensityGrid grid = density_grid(Matrix2Xd::Identity(2, 2), kEqual);
  EXPECT_THROW((void)density_contours(grid, {1.0}), std::invalid_argument);
  EXPECT_THROW((void)density_contours(grid, {nan}), std::invalid_argument);
}

}  // namespace density_test
}  // namespace qsmpc::harness
