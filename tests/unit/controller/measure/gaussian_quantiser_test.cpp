#include "controller/measure/quantisation/gaussian_quantiser.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include <gtest/gtest.h>

#include "controller/measure/quantisation/normal_quantiser.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace gaussian_quantiser_test {

using namespace testing;

// Sums of up to a thousand terms of order one.
constexpr double kRounding = 1e-12;

Gaussian random_gaussian(Generator& generator, Eigen::Index dim) {
  return {.mean = random_matrix(generator, dim, 1, 3.0), .covariance = random_spd(generator, dim)};
}

TEST(GaussianQuantiser, keeps_mass_mean_and_covariance_for_every_budget) {
  Generator generator(11);
  for (const int budget : {1, 2, 3, 5, 7, 10, 30, 64, 100, 333, 490, 1000}) {
    for (Eigen::Index dim = 1; dim <= 6; ++dim) {
      const Gaussian gaussian = random_gaussian(generator, dim);
      const GaussianQuantisation quantised = quantise(gaussian, budget);
      ASSERT_LE(quantised.measure.size(), budget);
      EXPECT_EQ(quantised.measure.size(),
                std::accumulate(quantised.levels.begin(), quantised.levels.end(), 1,
                                std::multiplies<>()));
      EXPECT_NEAR(quantised.measure.weights.sum(), 1.0, kRounding);
      EXPECT_GE(quantised.measure.weights.minCoeff(), 0.0);
      EXPECT_LE((mean_of(quantised.measure) - gaussian.mean).norm(), kRounding);
      EXPECT_LE(
          (covariance_of(quantised.measure) + quantised.within_covariance - gaussian.covariance)
              .norm(),
          kRounding);
      EXPECT_NEAR(quantised.w2 * quantised.w2, quantised.within_covariance.trace(), kRounding);
    }
  }
}

TEST(GaussianQuantiser, w2_is_the_root_mean_square_distance_to_the_nearest_point) {
  // 2e5 samples leave a statistical error of 0.2 %; 2 % would show a wrong cell.
  constexpr int kSamples = 200000;
  Generator generator(12);
  for (Eigen::Index dim = 2; dim <= 4; ++dim) {
    const Gaussian gaussian = random_gaussian(generator, dim);
    const GaussianQuantisation quantised = quantise(gaussian, 30);
    NormalSampler sampler(gaussian.covariance);
    double squares = 0.0;
    for (int i = 0; i < kSamples; ++i) {
      const Eigen::VectorXd sample = gaussian.mean + sampler(generator);
      squares +=
          (quantised.measure.locations.colwise() - sample).colwise().squaredNorm().minCoeff();
    }
    EXPECT_NEAR(std::sqrt(squares / kSamples), quantised.w2, 0.02 * quantised.w2) << dim;
  }
}

TEST(GaussianQuantiser, is_no_worse_than_the_best_known_product_grids) {
  struct Known {
    int dim;
    int budget;
    double w2;  // six decimals
  };
  for (const auto& [dim, budget, w2] :
       {Known{2, 100, 0.214182}, Known{2, 500, 0.101238}, Known{2, 1000, 0.071894},
        Known{3, 100, 0.526654}, Known{3, 500, 0.333073}, Known{3, 1000, 0.262319},
        Known{6, 100, 1.416713}, Known{6, 1000, 1.033611}}) {
    const Gaussian standard{.mean = Eigen::VectorXd::Zero(dim),
                            .covariance = Eigen::MatrixXd::Identity(dim, dim)};
    EXPECT_LE(quantise(standard, budget).w2, w2 + 1e-6) << dim << " " << budget;
  }
}

TEST(GaussianQuantiser, levels_are_the_best_of_all_shapes) {
  Generator generator(13);
  for (int repetition = 0; repetition < 20; ++repetition) {
    const Eigen::Vector3d variances = random_matrix(generator, 3, 1).cwiseAbs2();
    const int budget = 1 + static_cast<int>(uniform(generator, 0.0, 60.0));
    double least = std::numeric_limits<double>::infinity();
    for (int a = 1; a <= budget; ++a) {
      for (int b = 1; a * b <= budget; ++b) {
        const int c = budget / (a * b);
        least = std::min(least, variances[0] * normal_quantiser(a).distortion +
                                    variances[1] * normal_quantiser(b).distortion +
                                    variances[2] * normal_quantiser(c).distortion);
      }
    }
    const std::vector<int> levels = allot_levels(variances, budget);
    double found = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      found += variances[axis] * normal_quantiser(levels[axis]).distortion;
    }
    EXPECT_LE(levels[0] * levels[1] * levels[2], budget);
    EXPECT_NEAR(found, least, kRounding);
  }
}

/// min Σ v D(n) over all shapes, by exhaustive search.
double least_distortion(const Eigen::VectorXd& variances, Eigen::Index axis, int budget) {
  if (axis == variances.size()) return 0.0;
  if (axis + 1 == variances.size()) return variances[axis] * approximate_distortion(budget);
  double least = std::numeric_limits<double>::infinity();
  for (int level = 1; level <= budget; ++level) {
    least = std::min(least, variances[axis] * approximate_distortion(level) +
                                least_distortion(variances, axis + 1, budget / level));
  }
  return least;
}

TEST(GaussianQuantiser, levels_are_the_best_for_any_spread_of_variances_and_up_to_six_axes) {
  Generator generator(14);
  for (int repetition = 0; repetition < 100; ++repetition) {
    const Eigen::Index dim = 1 + repetition % 6;
    const int budget = dim <= 2 ? 3000 : dim <= 4 ? 200 : 40;
    // Some axes a hundred or a billion times narrower than others, as for a rounded singular
    // matrix.
    Eigen::VectorXd variances =
        (random_matrix(generator, dim, 1, 4.0).array().exp() / 50.0).square().matrix();
    if (repetition % 4 == 1) variances[0] *= 1e-18;
    if (repetition % 4 == 2) variances[0] = 0.0;
    if (repetition % 4 == 3) variances.setOnes();
    const std::vector<int> levels = allot_levels(variances, budget);
    double found = 0.0;
    int product = 1;
    for (Eigen::Index axis = 0; axis < dim; ++axis) {
      found += variances[axis] * approximate_distortion(levels[axis]);
      product *= levels[axis];
    }
    EXPECT_LE(product, budget);
    EXPECT_LE(found, (1.0 + kRounding) * least_distortion(variances, 0, budget));
  }
}

TEST(GaussianQuantiser, large_budgets_are_used) {
  for (const int budget : {10'000, 100'000}) {
    const GaussianQuantisation quantised = quantise(
        {.mean = Eigen::Vector3d::Zero(), .covariance = Eigen::Matrix3d::Identity()}, budget);
    EXPECT_LE(quantised.measure.size(), budget);
    EXPECT_GE(quantised.measure.size(), 0.95 * budget);  // 21·22·21 of 10 000, 46·46·47 of 100 000
  }
}

TEST(GaussianQuantiser, directions_without_variance_get_one_level) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance(0, 0) = 2.0;
  const GaussianQuantisation line =
      quantise({.mean = Eigen::Vector3d(1.0, 2.0, 3.0), .covariance = covariance}, 50);
  EXPECT_EQ(line.measure.size(), 50);
  EXPECT_NEAR(line.w2 * line.w2, 2.0 * normal_quantiser(50).distortion, kRounding);
  EXPECT_TRUE((line.measure.locations.row(1).array() == 2.0).all());

  const GaussianQuantisation point =
      quantise({.mean = Eigen::Vector3d(1.0, 2.0, 3.0), .covariance = Eigen::Matrix3d::Zero()}, 50);
  EXPECT_EQ(point.measure.size(), 1);
  EXPECT_EQ(point.w2, 0.0);
}

TEST(GaussianQuantiser, rotated_singular_covariance_keeps_its_moments) {
  const Eigen::Vector2d direction(0.6, -0.8);
  const Gaussian gaussian{.mean = Eigen::Vector2d(5.0, -1.0),
                          .covariance = 3.0 * direction * direction.transpose()};
  const GaussianQuantisation quantised = quantise(gaussian, 20);
  EXPECT_LE(
      (covariance_of(quantised.measure) + quantised.within_covariance - gaussian.covariance).norm(),
      kRounding);
  EXPECT_NEAR(quantised.w2 * quantised.w2, 3.0 * normal_quantiser(20).distortion, kRounding);
}

TEST(GaussianQuantiser, kinds_have_the_names_of_the_table) {
  EXPECT_EQ(quantiser_kind("product"), QuantiserKind::kProduct);
  EXPECT_EQ(quantiser_kind("lloyd"), QuantiserKind::kLloyd);
  EXPECT_EQ(quantisers().size(), 2U);
  EXPECT_THROW((void)quantiser_kind("Lloyd"), std::invalid_argument);
}

TEST(GaussianQuantiser, refuses_invalid_gaussians) {
  const double nan = std::nan("");
  const Eigen::Vector2d mean(0.0, 0.0);
  const Eigen::Matrix2d identity = Eigen::Matrix2d::Identity();
  Eigen::Matrix2d asymmetric = identity;
  asymmetric(0, 1) = 0.1;
  Eigen::Matrix2d indefinite = identity;
  indefinite(1, 1) = -0.5;
  Eigen::Matrix2d undefined = identity;
  undefined(0, 0) = nan;
  for (const Eigen::Matrix2d& covariance : {asymmetric, indefinite, undefined}) {
    EXPECT_THROW((void)quantise({.mean = mean, .covariance = covariance}, 10),
                 std::invalid_argument);
  }
  EXPECT_THROW((void)quantise({.mean = Eigen::Vector2d(nan, 0.0), .covariance = identity}, 10),
               std::invalid_argument);
  EXPECT_THROW((void)quantise({.mean = Eigen::Vector3d::Zero(), .covariance = identity}, 10),
               std::invalid_argument);
  EXPECT_THROW((void)quantise({.mean = Eigen::VectorXd(), .covariance = Eigen::MatrixXd()}, 10),
               std::invalid_argument);
  EXPECT_THROW((void)quantise({.mean = mean, .covariance = identity}, 0), std::invalid_argument);
  EXPECT_THROW((void)allot_levels(Eigen::Vector2d(1.0, -1.0), 10), std::invalid_argument);
  EXPECT_THROW((void)allot_levels(Eigen::Vector2d(1.0, nan), 10), std::invalid_argument);
}

}  // namespace gaussian_quantiser_test
}  // namespace qsmpc::controller
