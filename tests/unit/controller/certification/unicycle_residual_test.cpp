#include "controller/certification/unicycle_residual.hpp"

#include <cmath>
#include <complex>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <gtest/gtest.h>

#include "controller/measure/normal/normal_distribution.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace unicycle_residual_test {

using namespace testing;

constexpr models::UnicycleStructure kUnicycle{.reach = 0.15, .input_gain = 0.1};

/// (Re r, Im r) of r = e^{iφ} − e^{im − v/2}(1 + i(φ − m)) at φ.
Eigen::Vector2d residual(double heading, double mean, double variance) {
  const std::complex<double> fit =
      std::polar(std::exp(-0.5 * variance), mean) * std::complex<double>(1.0, heading - mean);
  const std::complex<double> rest = std::polar(1.0, heading) - fit;
  return {rest.real(), rest.imag()};
}

/// E f(Z) for Z ~ N(0, 1), f a matrix, entry by entry.
template <class Function>
Eigen::Matrix2d expectation(const Function& function) {
  Eigen::Matrix2d result;
  for (int entry = 0; entry < 4; ++entry) {
    result(entry) = boost::math::quadrature::gauss_kronrod<double, 61>::integrate(
        [&](double z) { return function(z)(entry) * normal_density(z); }, -9.0, 9.0, 3, 1e-9);
  }
  return result;
}

TEST(UnicycleResidual, moments_equal_numerical_quadrature) {
  Generator generator(71);
  for (int repetition = 0; repetition < 6; ++repetition) {
    const Eigen::Vector2d mean = random_matrix(generator, 2, 1, 3.0);
    const Eigen::Matrix2d covariance = random_spd(generator, 2, 0.5);
    // φ_i = m_i + a X, φ_j = m_j + b X + c Y.
    const double a = std::sqrt(covariance(0, 0));
    const double b = covariance(0, 1) / a;
    const double c = std::sqrt(covariance(1, 1) - b * b);
    const Eigen::Matrix2d expected = expectation([&](double x) {
      const Eigen::Vector2d first = residual(mean[0] + a * x, mean[0], covariance(0, 0));
      return Eigen::Matrix2d(expectation([&](double y) {
        const Eigen::Vector2d second = residual(mean[1] + b * x + c * y, mean[1], covariance(1, 1));
        return Eigen::Matrix2d(first * second.transpose());
      }));
    });
    const Eigen::Matrix2d moments =
        residual_moments(mean[0], covariance(0, 0), mean[1], covariance(1, 1), covariance(0, 1));
    EXPECT_LE((moments - expected).cwiseAbs().maxCoeff(), 1e-7);  // of the quadrature
  }
}

TEST(UnicycleResidual, moments_keep_their_digits_for_tiny_variances) {
  // Along the heading r is of second order, −(δ² − v)/2 with E = v²/2, across it of third, −δ³/6 +
  // vδ/2 with v³/6; for two headings with covariance c this gives c²/2 and c³/6.
  for (const double variance : {1e-3, 1e-6, 1e-9, 1e-12, 1e-18, 1e-60}) {
    for (const double share : {1.0, 0.5, -0.7}) {
      const double c = share * variance;
      const Eigen::Matrix2d moments = residual_moments(0.0, variance, 0.0, variance, c);
      const double square = 0.5 * c * c;
      EXPECT_NEAR(moments(0, 0), square, square * (2.0 * variance + 1e-14)) << variance;
      EXPECT_NEAR(moments(1, 1), c * square / 3.0, square * (2.0 * variance * variance + 1e-14));
      EXPECT_EQ(moments(0, 1), 0.0);
      EXPECT_EQ(moments(1, 0), 0.0);
    }
  }
}

TEST(UnicycleResidual, moments_have_no_step_where_the_formula_changes) {
  // True values at 1e-3 and 1 in both directions: the derivative of the moments is bounded by 2.
  for (const double at : {1e-3, -1e-3, 1.0, -1.0}) {
    const double step = 1e-12 * std::abs(at);
    const double below = residual_moments(0.0, 1.0, 0.0, 1.0, at - step)(0, 0);
    const double above = residual_moments(0.0, 1.0, 0.0, 1.0, at + step)(0, 0);
    EXPECT_NEAR(below, above, 4.0 * step * std::abs(at) + 1e-12 * above) << at;
  }
}

TEST(UnicycleResidual, moments_are_the_whole_unit_vector_for_huge_variances) {
  // The affine fit vanishes, and |e^{iφ}|² = 1. e^v overflows from 710 on.
  for (const double variance : {60.0, 709.0, 2000.0, 1e6}) {
    const Eigen::Matrix2d moments = residual_moments(0.7, variance, 0.7, variance, variance);
    EXPECT_LE((moments - 0.5 * Eigen::Matrix2d::Identity()).norm(), 1e-12) << variance;
    EXPECT_LE(residual_moments(0.7, variance, 0.2, variance, 0.1 * variance).norm(), 1e-12);
    EXPECT_TRUE(residual_moments(0.7, variance, 0.2, variance, -variance).allFinite());
  }
}

TEST(UnicycleResidual, headings_that_are_known_or_independent_have_none_in_common) {
  EXPECT_EQ(residual_moments(1.0, 0.0, 1.0, 0.0, 0.0), Eigen::Matrix2d::Zero());
  EXPECT_EQ(residual_moments(1.0, 0.3, -2.0, 0.5, 0.0), Eigen::Matrix2d::Zero());
}

TEST(UnicycleResidual, is_zero_along_a_walk_with_known_headings) {
  UnicycleResidual carried(kUnicycle, 3, 3);
  Eigen::MatrixXd transition = Eigen::MatrixXd::Identity(3, 3);
  for (int stage = 0; stage < 3; ++stage) {
    Gaussian law{.mean = Eigen::Vector3d(1.0, 2.0, 0.5), .covariance = Eigen::Matrix3d::Zero()};
    law.covariance(0, 0) = 0.1;
    carried.add_stage(law, transition);
    EXPECT_EQ(carried.root_mean_squares(), Eigen::Vector3d::Zero());
  }
}

TEST(UnicycleResidual, carried_residuals_match_simulation) {
  // Any affine maps will do: the headings of the resulting process are jointly Gaussian.
  Generator generator(72);
  constexpr int kHorizon = 4;
  constexpr int kSamples = 100000;
  const Gaussian belief{.mean = random_matrix(generator, 3, 1),
                        .covariance = random_spd(generator, 3, 0.1)};
  const Eigen::MatrixXd noise = random_spd(generator, 3, 0.05);
  std::vector<Eigen::MatrixXd> transitions;
  std::vector<Gaussian> laws = {belief};
  UnicycleResidual carried(kUnicycle, 3, kHorizon);
  for (int k = 0; k < kHorizon; ++k) {
    Eigen::MatrixXd transition = Eigen::MatrixXd::Identity(3, 3);
    transition.col(2) += random_matrix(generator, 3, 1, 0.3);
    transition.row(2) += random_matrix(generator, 1, 3, 0.5);
    carried.add_stage(laws.back(), transition);
    const Eigen::MatrixXd covariance =
        transition * laws.back().covariance * transition.transpose() + noise;
    const Eigen::VectorXd mean = laws.back().mean + Eigen::VectorXd(random_matrix(generator, 3, 1));
    laws.push_back({.mean = mean, .covariance = covariance});
    transitions.push_back(transition);
  }
  NormalSampler first(belief.covariance);
  NormalSampler later(noise);
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (int i = 0; i < kSamples; ++i) {
    Eigen::VectorXd deviation = first(generator);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int k = 0; k < kHorizon; ++k) {
      const double mean = laws[k].mean[2];
      sum = transitions[k] * sum;
      sum.head<2>() +=
          kUnicycle.reach * residual(mean + deviation[2], mean, laws[k].covariance(2, 2));
      deviation = transitions[k] * deviation + later(generator);
    }
    squares += sum.cwiseAbs2() / kSamples;
  }
  const Eigen::VectorXd expected = carried.root_mean_squares();
  // Squares of second order in a normal variable: a standard error of about a percent.
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(std::sqrt(squares[axis]), expected[axis], 0.03 * expected[axis]) << axis;
  }
}

}  // namespace unicycle_residual_test
}  // namespace qsmpc::controller
