#include "controller/measure/quantisation/normal_lloyd.hpp"

#include <cmath>
#include <stdexcept>
#include <thread>
#include <tuple>
#include <vector>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace normal_lloyd_test {

using namespace testing;

// Masses and means are sums over some 1e5 cells.
constexpr double kRounding = 1e-11;

Gaussian standard_normal(Eigen::Index dim) {
  return {.mean = Eigen::VectorXd::Zero(dim), .covariance = Eigen::MatrixXd::Identity(dim, dim)};
}

TEST(NormalLloyd, keeps_mass_mean_and_covariance) {
  for (int dim = 2; dim <= kLloydDimensions; ++dim) {
    for (const int count : {1, 2, 20}) {
      const NormalLloyd& lloyd = normal_lloyd(dim, count);
      EXPECT_LE(lloyd.measure.size(), count);
      EXPECT_GT(lloyd.measure.weights.minCoeff(), 0.0);
      EXPECT_NEAR(lloyd.measure.weights.sum(), 1.0, kRounding);
      EXPECT_LE(mean_of(lloyd.measure).norm(), kRounding);
      const Eigen::MatrixXd whole = covariance_of(lloyd.measure) + lloyd.within_covariance;
      EXPECT_LE((whole - Eigen::MatrixXd::Identity(dim, dim)).norm(), kRounding);
      for (int axis = 1; axis < dim; ++axis) {
        EXPECT_GE(lloyd.within_covariance(axis - 1, axis - 1), lloyd.within_covariance(axis, axis));
      }
    }
  }
}

TEST(NormalLloyd, is_nearly_as_good_as_the_best_known) {
  // Known values: W2 after long runs of Lloyd's method on samples. The remaining difference is due
  // to the steps of the cells' borders and to Lloyd's last rounds: 1.5 % in two and three
  // dimensions, 5 % in six, where a grid has few levels per axis.
  for (const auto& [dim, count, known, excess] :
       {std::tuple{2, 100, 0.1969, 0.015}, std::tuple{3, 100, 0.4799, 0.015},
        std::tuple{6, 100, 1.3167, 0.05}}) {
    EXPECT_LE(std::sqrt(normal_lloyd(dim, count).within_covariance.trace()),
              (1.0 + excess) * known);
  }
}

TEST(NormalLloyd, stays_above_what_no_quantiser_can_reach) {
  for (int dim = 2; dim <= 4; ++dim) {
    for (const int count : {2, 20, 100}) {
      const double rate = dim * std::pow(count, -2.0 / dim);
      EXPECT_GT(normal_lloyd(dim, count).within_covariance.trace(), rate);
    }
  }
}

TEST(NormalLloyd, is_remembered_and_the_same_for_all_threads) {
  std::vector<const NormalLloyd*> found(4, nullptr);
  {
    std::vector<std::jthread> threads;
    for (auto& pointer : found)
      threads.emplace_back([&pointer] { pointer = &normal_lloyd(2, 13); });
  }
  for (const NormalLloyd* pointer : found) EXPECT_EQ(pointer, &normal_lloyd(2, 13));
}

TEST(NormalLloyd, refuses_what_it_has_no_grid_for) {
  EXPECT_THROW((void)normal_lloyd(1, 10), std::invalid_argument);
  EXPECT_THROW((void)normal_lloyd(kLloydDimensions + 1, 10), std::invalid_argument);
  EXPECT_THROW((void)normal_lloyd(2, 0), std::invalid_argument);
  EXPECT_THROW((void)normal_lloyd(2, kLloydPoints + 1), std::invalid_argument);
}

TEST(SpreadQuantiser, is_better_than_the_grid_for_a_hundred_points_in_three_dimensions) {
  // The grid's 5 x 5 x 4 points have 0.526654. The gain is 8 %.
  EXPECT_LE(quantise(standard_normal(3), 100, QuantiserKind::kLloyd).w2, 0.93 * 0.526654);
}

TEST(SpreadQuantiser, keeps_the_moments_and_never_costs_more_than_the_product) {
  Generator generator(81);
  for (int repetition = 0; repetition < 40; ++repetition) {
    const Eigen::Index dim = 1 + repetition % 6;
    const int budget = std::vector{1, 2, 5, 12, 30}[repetition % 5];
    const Gaussian gaussian{.mean = random_matrix(generator, dim, 1, 3.0),
                            .covariance = random_spd(generator, dim)};
    const GaussianQuantisation product = quantise(gaussian, budget);
    const GaussianQuantisation spread = quantise(gaussian, budget, QuantiserKind::kLloyd);
    EXPECT_LE(spread.measure.size(), budget);
    EXPECT_LE(spread.w2, product.w2 + 1e-12);  // equal, up to rounding, if it is the product
    EXPECT_NEAR(spread.measure.weights.sum(), 1.0, kRounding);
    EXPECT_LE((mean_of(spread.measure) - gaussian.mean).norm(), kRounding);
    EXPECT_LE(
        (covariance_of(spread.measure) + spread.within_covariance - gaussian.covariance).norm(),
        kRounding);
    EXPECT_NEAR(spread.w2 * spread.w2, spread.within_covariance.trace(), kRounding);
  }
}

TEST(SpreadQuantiser, axes_with_little_variance_keep_their_grid) {
  // Two wide axes to spread the points over; the third deserves only one level.
  const Gaussian flat{.mean = Eigen::Vector3d::Zero(),
                      .covariance = Eigen::Vector3d(1.0, 1e-6, 1.0).asDiagonal()};
  const GaussianQuantisation spread = quantise(flat, 60, QuantiserKind::kLloyd);
  EXPECT_TRUE((spread.measure.locations.row(1).array() == 0.0).all());
  EXPECT_NEAR(spread.w2 * spread.w2, normal_lloyd(2, 60).within_covariance.trace() + 1e-6,
              kRounding);
  EXPECT_TRUE(spread.levels.empty());
}

TEST(SpreadQuantiser, directions_without_variance_take_no_points) {
  const Eigen::Matrix3d basis = Eigen::HouseholderQR<Eigen::Matrix3d>(
                                    (Eigen::Matrix3d() << 1, 2, 3, 4, 5, 6, 7, 8, 10).finished())
                                    .householderQ();
  const Gaussian plane{
      .mean = Eigen::Vector3d(1.0, 2.0, 3.0),
      .covariance = basis * Eigen::Vector3d(0.0, 1.0, 1.0).asDiagonal() * basis.transpose()};
  const GaussianQuantisation spread = quantise(plane, 60, QuantiserKind::kLloyd);
  EXPECT_NEAR(spread.w2 * spread.w2, normal_lloyd(2, 60).within_covariance.trace(), kRounding);

  const Gaussian point{.mean = Eigen::Vector3d(1.0, 2.0, 3.0),
                       .covariance = Eigen::Matrix3d::Zero()};
  EXPECT_EQ(quantise(point, 60, QuantiserKind::kLloyd).measure.size(), 1);
  EXPECT_EQ(quantise(point, 60, QuantiserKind::kLloyd).w2, 0.0);
}

TEST(SpreadQuantiser, is_the_product_on_the_line_and_beyond_its_grids) {
  EXPECT_EQ(quantise(standard_normal(1), 50, QuantiserKind::kLloyd).w2,
            quantise(standard_normal(1), 50).w2);
  const GaussianQuantisation large = quantise(standard_normal(2), 100'000, QuantiserKind::kLloyd);
  EXPECT_EQ(large.w2, quantise(standard_normal(2), 100'000).w2);
  EXPECT_EQ(large.levels.size(), 2U);
}

TEST(SpreadQuantiser, refuses_invalid_gaussians_and_budgets) {
  EXPECT_THROW((void)quantise(standard_normal(2), 0, QuantiserKind::kLloyd), std::invalid_argument);
  Gaussian indefinite = standard_normal(2);
  indefinite.covariance(0, 0) = -1.0;
  EXPECT_THROW((void)quantise(indefinite, 10, QuantiserKind::kLloyd), std::invalid_argument);
}

}  // namespace normal_lloyd_test
}  // namespace qsmpc::controller
