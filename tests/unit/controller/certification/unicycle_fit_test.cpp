// The affine fit of a unicycle's step: its law, and bounds on what it leaves and on its slopes,
// over all headings of its region.
#include "controller/certification/unicycle_fit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "models/constants.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace unicycle_fit_test {

using namespace testing;

constexpr models::UnicycleStructure kUnicycle{.reach = 0.15, .input_gain = 0.1};
constexpr int kHeading = kUnicycle.heading;

struct Case {
  Gaussian law;
  UnicycleFeedback feedback;
};

/// Any mean heading, deviations from 0.01 to 1 rad, regions from 1 to 6 deviations to either side.
Case random_case(Generator& generator) {
  const Eigen::VectorXd draw = random_matrix(generator, 3, 1).cwiseAbs().cwiseMin(1.0);
  const double deviation = std::pow(10.0, -2.0 * draw[0]);
  Case one{.law = {.mean = random_matrix(generator, 3, 1, 3.0),
                   .covariance = 0.01 * Eigen::MatrixXd::Identity(3, 3)},
           .feedback = {.gain = random_matrix(generator, 1, 3),
                        .saturation = {.mean = 0.2, .slope = draw[1]},
                        .away = (1.0 + 5.0 * draw[2]) * deviation}};
  one.law.covariance(kHeading, kHeading) = deviation * deviation;
  return one;
}

StatisticalLinearisation fit_of(const Case& one,
                                const models::UnicycleStructure& unicycle = kUnicycle) {
  StatisticalLinearisation fit;
  fit.residual = StageError::none(3);
  fit.closed_form = Eigen::VectorXd::Zero(3);
  fit_unicycle(unicycle, one.law, one.feedback, 1, fit);
  return fit;
}

TEST(UnicycleFit, is_the_mean_of_the_step_and_of_its_slopes) {
  Generator generator(73);
  for (int repetition = 0; repetition < 20; ++repetition) {
    const Case one = random_case(generator);
    const StatisticalLinearisation fit = fit_of(one);
    const double shrink = std::exp(-0.5 * one.law.covariance(kHeading, kHeading));
    const std::complex<double> turned =
        kUnicycle.reach * shrink * std::polar(1.0, one.law.mean[kHeading]);
    EXPECT_NEAR(fit.next_mean[0], one.law.mean[0] + turned.real(), 1e-15);
    EXPECT_NEAR(fit.next_mean[1], one.law.mean[1] + turned.imag(), 1e-15);
    EXPECT_NEAR(fit.next_mean[2], one.law.mean[2] + 0.1 * 0.2, 1e-15);
    EXPECT_NEAR(fit.transition(0, kHeading), -turned.imag(), 1e-15);
    EXPECT_NEAR(fit.transition(1, kHeading), turned.real(), 1e-15);
    const Eigen::RowVectorXd turning = 0.1 * one.feedback.saturation.slope * one.feedback.gain;
    EXPECT_NEAR(fit.transition(kHeading, 0), turning[0], 1e-15);
    EXPECT_NEAR(fit.transition(kHeading, kHeading), 1.0 + turning[kHeading], 1e-15);
  }
}

// Over the region: what the fit leaves, its slopes, and those of the step. None is below what
// occurs there, and the step's are at most a half above it.
TEST(UnicycleFit, bounds_residual_and_slopes_over_its_region) {
  Generator generator(74);
  for (int repetition = 0; repetition < 200; ++repetition) {
    SCOPED_TRACE(repetition);
    const Case one = random_case(generator);
    const StatisticalLinearisation fit = fit_of(one);
    const double mean = one.law.mean[kHeading];
    const double shrink = std::exp(-0.5 * one.law.covariance(kHeading, kHeading));
    const std::complex<double> i(0.0, 1.0);
    Eigen::Vector2d left = Eigen::Vector2d::Zero();
    Eigen::Vector2d stretch = Eigen::Vector2d::Zero();
    Eigen::Vector2d growth = Eigen::Vector2d::Zero();
    const auto widen = [](Eigen::Vector2d& most, const std::complex<double>& value) {
      most = most.cwiseMax(kUnicycle.reach *
                           Eigen::Vector2d(std::abs(value.real()), std::abs(value.imag())));
    };
    for (int step = -200; step <= 200; ++step) {
      const double away = one.feedback.away * step / 200.0;
      const std::complex<double> at_mean = std::polar(1.0, mean);
      const std::complex<double> there = std::polar(1.0, mean + away);
      widen(left, there - shrink * at_mean * (1.0 + i * away));
      widen(stretch, i * there - i * shrink * at_mean);
      widen(growth, i * there);
    }
    for (const int axis : {kUnicycle.x, kUnicycle.y}) {
      constexpr double kRounding = 1e-14;
      EXPECT_GE(fit.residual.largest()[axis], left[axis] - kRounding);
      EXPECT_GE(fit.stretch(axis, kHeading), stretch[axis] - kRounding);
      EXPECT_GE(fit.growth(axis, kHeading), growth[axis] - kRounding);
      EXPECT_LE(fit.growth(axis, kHeading), std::min(kUnicycle.reach, 1.5 * growth[axis]));
    }
    EXPECT_EQ(fit.growth(0, 0), 1.0);
    EXPECT_EQ(fit.stretch.col(0).norm(), 0.0);
    EXPECT_GE(fit.growth(kHeading, kHeading), std::abs(1.0 + 0.1 * one.feedback.gain[kHeading]));
    EXPECT_NEAR(fit.growth(kHeading, 1), std::abs(0.1 * one.feedback.gain[1]), 1e-15);
  }
}

// A car that stands still is not moved by any heading.
TEST(UnicycleFit, without_reach_leaves_nothing) {
  Generator generator(75);
  Case one = random_case(generator);
  one.feedback.away = kInfinity;
  models::UnicycleStructure still = kUnicycle;
  still.reach = 0.0;
  const StatisticalLinearisation fit = fit_of(one, still);
  EXPECT_EQ(fit.residual.bounds.norm(), 0.0);
  EXPECT_EQ(fit.stretch.norm(), 0.0);
  EXPECT_EQ(fit.next_mean.head(2), one.law.mean.head(2));
}

}  // namespace unicycle_fit_test
}  // namespace qsmpc::controller
