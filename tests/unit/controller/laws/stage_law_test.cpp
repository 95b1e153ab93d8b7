// Laws of one stage: moments, draws and probabilities, and the numbers that these are computed
// from.
#include "controller/laws/stage_law.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/laws/gaussian_split.hpp"
#include "controller/laws/mixture_reduction.hpp"
#include "controller/laws/normal_grid.hpp"
#include "controller/measure/normal/normal_distribution.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace stage_law_test {

using namespace testing;

constexpr double kRounding = 1e-12;

GaussianMixture random_mixture(Generator& generator, Eigen::Index dim, Eigen::Index count) {
  GaussianMixture mixture{
      .weights = random_measure(generator, dim, count).weights,
      .means = random_matrix(generator, dim, count, 2.0),
      .covariances = {},
  };
  for (Eigen::Index i = 0; i < count; ++i) {
    mixture.covariances.push_back(random_spd(generator, dim, 0.2));
  }
  return mixture;
}

HermiteExpansion random_expansion(Generator& generator, Eigen::Index dim, int order) {
  HermiteBasis basis(dim, order);
  return {.basis = basis, .coefficients = random_matrix(generator, dim, basis.terms())};
}

TEST(StageLaw, moments_are_those_of_its_draws) {
  constexpr Eigen::Index kDraws = 200'000;
  Generator generator(1);
  const DiscreteMeasure points = random_measure(generator, 3, 20);
  const std::vector<StageLaw> laws = {points, random_mixture(generator, 3, 5),
                                      random_expansion(generator, 3, 2)};
  for (const StageLaw& law : laws) {
    ASSERT_EQ(law_dim(law), 3);
    const Points drawn = law_draws(law, random_draws(3, kDraws, 7));
    const Eigen::MatrixXd covariance = covariance_of(law);
    const Eigen::VectorXd mean = drawn.rowwise().mean();
    // Five standard deviations of a sum over the coordinates.
    EXPECT_LE((mean - mean_of(law)).norm(), 5.0 * std::sqrt(covariance.trace() / kDraws));
    const Points centred = drawn.colwise() - mean;
    const Eigen::MatrixXd sampled = centred * centred.transpose() / double{kDraws};
    // A factor of three allows for tails heavier than a Gaussian's.
    EXPECT_LE((sampled - covariance).norm(), 15.0 * covariance.trace() / std::sqrt(double{kDraws}));
  }
  EXPECT_LE((mean_of(laws[0]) - mean_of(points)).norm(), kRounding);
}

TEST(StageLaw, probability_of_points_is_their_weight_and_of_a_gaussian_near_the_exact_one) {
  SafeSet safe_set = unbounded_safe_set(2);
  safe_set.bounds.upper[0] = 1.0;
  const StandardDraws draws = quasi_random_draws(2, 1 << 17);
  DiscreteMeasure points{.locations = Points(2, 3), .weights = Eigen::Vector3d(0.5, 0.3, 0.2)};
  points.locations << 0.0, 1.0, 2.0, 0.0, 0.0, 0.0;
  EXPECT_DOUBLE_EQ(unsafe_probability(points, safe_set, draws), 0.5);  // touching is unsafe
  for (const double margin : {0.0, 1.0, 3.0}) {
    const StageLaw law =
        gaussian_law({.mean = Eigen::Vector2d(1.0 - 0.5 * margin, 0.0),
                      .covariance = (Eigen::Matrix2d() << 0.25, 0.1, 0.1, 0.3).finished()});
    const double exact = normal_cumulative(-margin);
    // A third of the standard deviation of the same number of random draws.
    EXPECT_NEAR(unsafe_probability(law, safe_set, draws), exact,
                std::sqrt(exact * (1.0 - exact) / static_cast<double>(draws.count())) / 3.0);
  }
}

TEST(StageLaw, what_is_not_finite_is_unsafe) {
  const StageLaw lost = lost_law(2);
  EXPECT_FALSE(is_finite(lost));
  EXPECT_EQ(unsafe_probability(lost, unbounded_safe_set(2), quasi_random_draws(2, 8)), 1.0);
}

TEST(StandardDraws, are_those_of_their_seed_and_standard_normal) {
  constexpr Eigen::Index kCount = 100'000;
  const StandardDraws first = random_draws(2, kCount, 3);
  EXPECT_EQ(first.normals, random_draws(2, kCount, 3).normals);
  EXPECT_NE(first.normals, random_draws(2, kCount, 4).normals);
  EXPECT_NE(first.normals.row(0), first.normals.row(1));
  for (const StandardDraws& draws : {first, quasi_random_draws(2, kCount)}) {
    EXPECT_TRUE((draws.choices.array() > 0.0 && draws.choices.array() <= 1.0).all());
    EXPECT_NEAR(draws.choices.mean(), 0.5, 0.005);
    // Five standard deviations of random draws.
    for (const auto& row : draws.normals.rowwise()) {
      EXPECT_NEAR(row.mean(), 0.0, 5.0 / std::sqrt(double{kCount}));
      EXPECT_NEAR(row.squaredNorm() / kCount, 1.0, 5.0 * std::sqrt(2.0 / kCount));
    }
    EXPECT_NEAR(draws.normals.row(0).dot(draws.normals.row(1)) / kCount, 0.0,
                5.0 / std::sqrt(double{kCount}));
  }
}

TEST(NormalQuantile, inverts_the_distribution_function) {
  for (const double x : {-8.0, -2.0, 0.0, 0.3, 4.0}) {
    EXPECT_NEAR(normal_quantile(normal_cumulative(x)), x, 1e-11);
  }
}

/// E ξ^power for ξ ~ N(0, 1).
double normal_moment(int power) {
  if (power % 2 == 1) return 0.0;
  double moment = 1.0;
  for (int factor = power - 1; factor > 0; factor -= 2) moment *= factor;
  return moment;
}

TEST(NormalGrid, is_exact_up_to_twice_its_order_and_one) {
  for (const Eigen::Index dim : {1, 2, 3, 4}) {
    for (const int order : {1, 2, 3}) {
      for (const int most : {1, 1'000'000}) {  // sparse grid and product grid
        const NormalGrid grid = normal_grid(dim, order, most);
        const HermiteBasis monomials(dim, 2 * order + 1);
        for (const auto& exponents : monomials.exponents().colwise()) {
          double sum = 0.0;
          double expected = 1.0;
          for (Eigen::Index axis = 0; axis < dim; ++axis) {
            expected *= normal_moment(exponents[axis]);
          }
          for (Eigen::Index i = 0; i < grid.nodes.cols(); ++i) {
            double value = grid.weights[i];
            for (Eigen::Index axis = 0; axis < dim; ++axis) {
              value *= std::pow(grid.nodes(axis, i), exponents[axis]);
            }
            sum += value;
          }
          // Relative to the highest moments, 105.
          EXPECT_NEAR(sum, expected, 1e-10) << dim << " " << order << " " << most;
        }
      }
    }
  }
}

TEST(NormalGrid, is_sparse_where_the_product_has_too_many_nodes) {
  EXPECT_EQ(normal_grid(3, 3, 1000).nodes.cols(), 64);
  EXPECT_EQ(normal_grid(6, 3, 5000).nodes.cols(), 4096);
  EXPECT_LT(normal_grid(6, 3, 1000).nodes.cols(), 500);
}

TEST(HermiteBasis, polynomials_are_orthonormal) {
  const HermiteBasis basis(3, 3);
  EXPECT_EQ(basis.terms(), 20);
  const NormalGrid grid = normal_grid(3, 3, 1000);
  const Eigen::MatrixXd values = basis.values(grid.nodes);
  const Eigen::MatrixXd products = values * grid.weights.asDiagonal() * values.transpose();
  EXPECT_LE((products - Eigen::MatrixXd::Identity(20, 20)).cwiseAbs().maxCoeff(), kRounding);
  EXPECT_EQ(values.row(2), Eigen::RowVectorXd(grid.nodes.row(1)));
}

TEST(HermiteBasis, refuses_invalid_arguments) {
  EXPECT_THROW(HermiteBasis(0, 2), std::invalid_argument);
  EXPECT_THROW(HermiteBasis(2, 0), std::invalid_argument);
  EXPECT_THROW(HermiteBasis(30, 8), std::invalid_argument);
}

// ξ = R ξ' + S ν with S Sᵀ = I − R Rᵀ: the mean over ν by quadrature.
TEST(HermiteBasis, conditional_expectation_is_the_mean_over_what_is_not_given) {
  Generator generator(2);
  const HermiteBasis basis(2, 4);
  const Eigen::MatrixXd correlation = random_matrix(generator, 2, 2, 0.6);
  const Eigen::MatrixXd rest =
      Eigen::MatrixXd::Identity(2, 2) - correlation * correlation.transpose();
  const Eigen::MatrixXd root = models::cholesky_factor(rest);
  const Eigen::MatrixXd coefficients = random_matrix(generator, 1, basis.terms());
  const Eigen::MatrixXd given = coefficients * basis.conditional_expectation(correlation);
  const NormalGrid grid = normal_grid(2, 4, 1000);
  for (int round = 0; round < 5; ++round) {
    const Eigen::Vector2d at = random_matrix(generator, 2, 1, 2.0);
    const Points inner = (root * grid.nodes).colwise() + Eigen::Vector2d(correlation * at);
    const double mean = (coefficients * basis.values(inner)).row(0).dot(grid.weights);
    EXPECT_NEAR((given * basis.values(at))(0, 0), mean, 1e-10);
  }
}

TEST(NormalSplit, has_the_moments_of_the_normal_law) {
  for (const int parts : {3, 5}) {
    const NormalSplit& split = normal_split(parts);
    ASSERT_EQ(split.weights.size(), parts);
    const double variance = split.deviation * split.deviation;
    for (int power = 0; power <= 2 * parts - 1; ++power) {
      // E (m + σ ξ)^power by the binomial theorem.
      double sum = 0.0;
      for (int i = 0; i < parts; ++i) {
        double binomial = 1.0;
        for (int k = 0; k <= power; ++k) {
          sum += split.weights[i] * binomial * std::pow(split.means[i], power - k) *
                 std::pow(variance, 0.5 * k) * normal_moment(k);
          binomial *= static_cast<double>(power - k) / (k + 1);
        }
      }
      EXPECT_NEAR(sum, normal_moment(power), 1e-11) << parts << " parts, power " << power;
    }
  }
}

TEST(SplitGaussian, keeps_mean_and_covariance_and_narrows_one_direction) {
  Generator generator(3);
  const Gaussian gaussian{.mean = random_matrix(generator, 3, 1),
                          .covariance = random_spd(generator, 3)};
  const Eigen::VectorXd direction = random_matrix(generator, 3, 1).normalized();
  for (const int parts : {3, 5}) {
    const NormalSplit& split = normal_split(parts);
    const StageLaw mixture = split_gaussian(gaussian, direction, split);
    EXPECT_LE((mean_of(mixture) - gaussian.mean).norm(), kRounding);
    EXPECT_LE((covariance_of(mixture) - gaussian.covariance).norm(), kRounding);
    const auto& narrowed = std::get<GaussianMixture>(mixture).covariances.front();
    EXPECT_NEAR(models::symmetric_eigenvalues(narrowed).prod() /
                    models::symmetric_eigenvalues(gaussian.covariance).prod(),
                split.deviation * split.deviation, 1e-9);
  }
}

TEST(ReduceMixture, keeps_mean_and_covariance) {
  Generator generator(4);
  const GaussianMixture mixture = random_mixture(generator, 3, 12);
  for (const int kept : {1, 4, 12, 20}) {
    const GaussianMixture reduced = reduce_mixture(mixture, kept);
    EXPECT_EQ(reduced.size(), std::min(kept, 12));
    EXPECT_NEAR(reduced.weights.sum(), 1.0, kRounding);
    EXPECT_LE((mean_of(StageLaw(reduced)) - mean_of(StageLaw(mixture))).norm(), kRounding);
    EXPECT_LE((covariance_of(StageLaw(reduced)) - covariance_of(StageLaw(mixture))).norm(),
              kRounding);
  }
}

TEST(ReduceMixture, merges_what_is_alike_first) {
  Generator generator(5);
  GaussianMixture mixture = random_mixture(generator, 2, 3);
  mixture.means << 0.0, 3.0, 0.1, 0.0, 3.0, 0.0;
  mixture.covariances[2] = mixture.covariances[0];
  const GaussianMixture reduced = reduce_mixture(mixture, 2);
  ASSERT_EQ(reduced.size(), 2);
  EXPECT_EQ(reduced.means.col(1), mixture.means.col(1));
  EXPECT_NEAR(reduced.weights[0], mixture.weights[0] + mixture.weights[2], kRounding);
}

TEST(ReduceMixture, takes_components_without_spread) {
  const GaussianMixture points{
      .weights = Eigen::Vector3d(0.2, 0.3, 0.5),
      .means = (Points(1, 3) << 0.0, 0.1, 5.0).finished(),
      .covariances = std::vector<Eigen::MatrixXd>(3, Eigen::MatrixXd::Zero(1, 1))};
  const GaussianMixture reduced = reduce_mixture(points, 2);
  ASSERT_EQ(reduced.size(), 2);
  EXPECT_NEAR(reduced.means(0, 0), 0.06, kRounding);
  EXPECT_EQ(reduced.means(0, 1), 5.0);
}

}  // namespace stage_law_test
}  // namespace qsmpc::controller
