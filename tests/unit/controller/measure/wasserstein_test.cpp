#include "controller/measure/wasserstein.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "controller/measure/compression/compression.hpp"
#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "models/linear_algebra.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace wasserstein_test {

using namespace testing;

// Sums of some hundred squares of order ten, and a root where W2 is of order one.
constexpr double kRounding = 1e-12;

DiscreteMeasure uniform_measure(Generator& generator, Eigen::Index dim, Eigen::Index size) {
  return {.locations = random_matrix(generator, dim, size, 2.0),
          .weights = Eigen::VectorXd::Constant(size, 1.0 / static_cast<double>(size))};
}

/// With equal weights on equally many points, some permutation is an optimal plan (Birkhoff).
double cheapest_permutation(const DiscreteMeasure& first, const DiscreteMeasure& second) {
  std::vector<int> order(first.size());
  std::iota(order.begin(), order.end(), 0);
  double least = std::numeric_limits<double>::infinity();
  do {
    double cost = 0.0;
    for (Eigen::Index i = 0; i < first.size(); ++i) {
      cost += (first.locations.col(i) - second.locations.col(order[i])).squaredNorm();
    }
    least = std::min(least, cost / static_cast<double>(first.size()));
  } while (std::next_permutation(order.begin(), order.end()));
  return std::sqrt(least);
}

std::vector<Eigen::Index> sorted_indices(const DiscreteMeasure& measure) {
  std::vector<Eigen::Index> order(measure.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return measure.locations(0, a) < measure.locations(0, b); });
  return order;
}

/// On the line, the plan that maps quantiles to quantiles is optimal.
double quantile_coupling(const DiscreteMeasure& first, const DiscreteMeasure& second) {
  const auto rows = sorted_indices(first);
  const auto columns = sorted_indices(second);
  double cost = 0.0;
  double left = first.weights[rows[0]];
  double right = second.weights[columns[0]];
  for (std::size_t i = 0, j = 0; i < rows.size() && j < columns.size();) {
    const double moved = std::min(left, right);
    const double distance = first.locations(0, rows[i]) - second.locations(0, columns[j]);
    cost += moved * distance * distance;
    left -= moved;
    right -= moved;
    if (left <= 0.0 && ++i < rows.size()) left = first.weights[rows[i]];
    if (right <= 0.0 && ++j < columns.size()) right = second.weights[columns[j]];
  }
  return std::sqrt(cost);
}

TEST(Wasserstein, is_the_cheapest_assignment_of_equal_weights) {
  Generator generator(31);
  for (const Eigen::Index dim : {1, 2, 5}) {
    for (const Eigen::Index size : {1, 2, 4, 7}) {
      const DiscreteMeasure first = uniform_measure(generator, dim, size);
      const DiscreteMeasure second = uniform_measure(generator, dim, size);
      EXPECT_NEAR(wasserstein2(first, second), cheapest_permutation(first, second), kRounding);
    }
  }
}

TEST(Wasserstein, on_the_line_is_the_quantile_coupling) {
  Generator generator(32);
  for (const auto& [rows, columns] : {std::pair{1, 9}, std::pair{13, 8}, std::pair{150, 220}}) {
    const DiscreteMeasure first = random_measure(generator, 1, rows);
    const DiscreteMeasure second = random_measure(generator, 1, columns);
    EXPECT_NEAR(wasserstein2(first, second), quantile_coupling(first, second), kRounding);
  }
}

TEST(Wasserstein, of_a_translated_measure_is_the_length_of_the_way) {
  Generator generator(33);
  const DiscreteMeasure measure = random_measure(generator, 3, 60);
  for (const double length : {0.0, 1e-3, 0.5, 40.0}) {
    DiscreteMeasure moved = measure;
    moved.locations.colwise() += length * Eigen::Vector3d(2.0, -1.0, 2.0) / 3.0;
    EXPECT_NEAR(wasserstein2(measure, moved), length, kRounding * (1.0 + length));
  }
}

TEST(Wasserstein, is_symmetric_and_keeps_the_triangle_inequality) {
  Generator generator(34);
  for (int repetition = 0; repetition < 20; ++repetition) {
    const DiscreteMeasure first = random_measure(generator, 2, 12);
    const DiscreteMeasure second = random_measure(generator, 2, 19);
    const DiscreteMeasure third = random_measure(generator, 2, 7);
    const double direct = wasserstein2(first, third);
    EXPECT_NEAR(direct, wasserstein2(third, first), kRounding);
    EXPECT_LE(direct, wasserstein2(first, second) + wasserstein2(second, third) + kRounding);
  }
}

TEST(Wasserstein, points_without_weight_and_split_points_change_nothing) {
  Generator generator(35);
  const DiscreteMeasure measure = random_measure(generator, 2, 10);
  const DiscreteMeasure other = random_measure(generator, 2, 15);
  DiscreteMeasure same{.locations = Points(2, 21), .weights = Eigen::VectorXd(21)};
  same.locations << measure.locations, measure.locations, Eigen::Vector2d(1e3, -1e3);
  same.weights << 0.25 * measure.weights, 0.75 * measure.weights, 0.0;
  EXPECT_NEAR(wasserstein2(same, other), wasserstein2(measure, other), kRounding);
  // Splitting a weight loses its last bit; a mass of 1e-16 over a distance of 4 contributes 4e-8.
  EXPECT_NEAR(wasserstein2(same, measure), 0.0, 1e-7);
}

TEST(Wasserstein, weights_over_many_orders_of_magnitude_are_carried) {
  DiscreteMeasure first{.locations = Points(1, 3), .weights = Eigen::VectorXd(3)};
  first.locations << 0.0, 1.0, 2.0;
  first.weights << 1.0 - 1e-9 - 1e-12, 1e-9, 1e-12;
  const DiscreteMeasure origin{.locations = Points::Zero(1, 1),
                               .weights = Eigen::VectorXd::Ones(1)};
  EXPECT_NEAR(wasserstein2(first, origin), std::sqrt(1e-9 + 4e-12), 1e-12);
}

TEST(Wasserstein, is_no_more_than_the_cost_of_a_compression_and_equals_it_on_voronoi_cells) {
  Generator generator(36);
  const DiscreteMeasure measure = random_measure(generator, 3, 300);
  for (const int count : {5, 40}) {
    const Compression tree = compress(measure, count, 0);
    EXPECT_LE(wasserstein2(measure, tree.measure), tree.w2 + kRounding);
    const Compression voronoi = compress(measure, count, kToConvergence);
    EXPECT_NEAR(wasserstein2(measure, voronoi.measure), voronoi.w2, kRounding);
  }
}

TEST(Wasserstein, of_gaussians_with_a_common_eigenbasis_adds_the_differences_of_deviations) {
  Generator generator(37);
  const Eigen::Matrix3d basis = models::symmetric_eigen(random_spd(generator, 3)).vectors;
  const Eigen::Vector3d deviations(0.5, 0.9, 2.0);
  const Eigen::Vector3d others(0.4, 1.5, 2.0);
  const Gaussian first{
      .mean = Eigen::Vector3d(1.0, 2.0, 3.0),
      .covariance = basis * deviations.cwiseAbs2().asDiagonal() * basis.transpose()};
  const Gaussian second{.mean = Eigen::Vector3d(1.0, 2.5, 3.0),
                        .covariance = basis * others.cwiseAbs2().asDiagonal() * basis.transpose()};
  EXPECT_NEAR(wasserstein2(first, second), std::sqrt((deviations - others).squaredNorm() + 0.25),
              kRounding);
}

TEST(Wasserstein, of_singular_gaussians_counts_the_directions_without_variance) {
  const Gaussian line{.mean = Eigen::Vector2d::Zero(),
                      .covariance = Eigen::Vector2d(4.0, 0.0).asDiagonal()};
  const Gaussian across{.mean = Eigen::Vector2d::Zero(),
                        .covariance = Eigen::Vector2d(0.0, 9.0).asDiagonal()};
  const Gaussian point{.mean = Eigen::Vector2d(3.0, 4.0), .covariance = Eigen::Matrix2d::Zero()};
  EXPECT_NEAR(wasserstein2(line, across), std::sqrt(4.0 + 9.0), kRounding);
  EXPECT_NEAR(wasserstein2(line, point), std::sqrt(4.0 + 25.0), kRounding);
  EXPECT_EQ(wasserstein2(point, point), 0.0);
}

TEST(Wasserstein, of_gaussians_is_the_formula_of_bures) {
  Generator generator(38);
  for (Eigen::Index dim = 1; dim <= 6; ++dim) {
    const Gaussian first{.mean = random_matrix(generator, dim, 1),
                         .covariance = random_spd(generator, dim)};
    const Gaussian second{.mean = random_matrix(generator, dim, 1),
                          .covariance = random_spd(generator, dim)};
    // The eigenvalues of Σ₁^½ Σ₂ Σ₁^½ are those of Σ₁Σ₂, and with Σ₁ = L Lᵀ those of Lᵀ Σ₂ L.
    const Eigen::MatrixXd root = models::cholesky_factor(first.covariance);
    const double overlap =
        models::symmetric_eigenvalues(root.transpose() * second.covariance * root)
            .cwiseSqrt()
            .sum();
    const double squared = (first.mean - second.mean).squaredNorm() + first.covariance.trace() +
                           second.covariance.trace() - 2.0 * overlap;
    EXPECT_NEAR(wasserstein2(first, second), std::sqrt(squared), 1e-10);  // eigenvalues, a root
    EXPECT_NEAR(wasserstein2(first, first), 0.0, kRounding);
  }
}

TEST(Wasserstein, of_close_gaussians_keeps_its_digits) {
  const Gaussian first{.mean = Eigen::Vector2d::Zero(), .covariance = Eigen::Matrix2d::Identity()};
  Gaussian second = first;
  second.covariance *= (1.0 + 1e-9) * (1.0 + 1e-9);
  EXPECT_NEAR(wasserstein2(first, second), std::sqrt(2.0) * 1e-9, 1e-15);  // 1 + 1e-9 is rounded
}

TEST(Wasserstein, of_quantised_gaussians_is_within_their_errors_of_the_gaussians) {
  const Gaussian first{.mean = Eigen::Vector2d(0.0, 0.0),
                       .covariance = Eigen::Vector2d(1.0, 0.3).asDiagonal()};
  const Gaussian second{.mean = Eigen::Vector2d(0.7, -0.2),
                        .covariance = Eigen::Vector2d(0.5, 0.6).asDiagonal()};
  const GaussianQuantisation coarse = quantise(first, 100);
  const GaussianQuantisation fine = quantise(second, 1000);
  const double discrete = wasserstein2(coarse.measure, fine.measure);
  const double exact = wasserstein2(first, second);
  EXPECT_LE(discrete, exact + coarse.w2 + fine.w2);
  EXPECT_GE(discrete, exact - coarse.w2 - fine.w2);
  EXPECT_NEAR(discrete, exact, 0.05);  // errors of 0.15 and 0.05, in different directions
}

TEST(Wasserstein, refuses_invalid_measures_and_other_dimensions) {
  Generator generator(39);
  const DiscreteMeasure good = random_measure(generator, 2, 5);
  DiscreteMeasure undefined = good;
  undefined.weights[0] = std::nan("");
  DiscreteMeasure negative = good;
  negative.weights[0] += negative.weights[1] + 0.1;
  negative.weights[1] = -0.1;
  DiscreteMeasure weightless = good;
  weightless.weights.setZero();
  for (const DiscreteMeasure& bad :
       {undefined, negative, weightless, DiscreteMeasure{}, random_measure(generator, 3, 5)}) {
    EXPECT_THROW((void)wasserstein2(good, bad), std::invalid_argument);
    EXPECT_THROW((void)wasserstein2(bad, good), std::invalid_argument);
  }
  const Gaussian plane{.mean = Eigen::Vector2d::Zero(), .covariance = Eigen::Matrix2d::Identity()};
  const Gaussian line{.mean = Eigen::VectorXd::Zero(1), .covariance = Eigen::MatrixXd::Ones(1, 1)};
  EXPECT_THROW((void)wasserstein2(plane, line), std::invalid_argument);
  Gaussian indefinite = plane;
  indefinite.covariance(0, 0) = -1.0;
  EXPECT_THROW((void)wasserstein2(plane, indefinite), std::invalid_argument);
}

TEST(Wasserstein, too_large_a_problem_is_refused) {
  const Eigen::Index size = 5000;  // its square exceeds kTransportPairs
  const DiscreteMeasure large{
      .locations = Points::Zero(1, size),
      .weights = Eigen::VectorXd::Constant(size, 1.0 / static_cast<double>(size))};
  EXPECT_THROW((void)wasserstein2(large, large), std::length_error);
}

}  // namespace wasserstein_test
}  // namespace qsmpc::controller
