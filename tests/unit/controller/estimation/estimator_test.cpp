// Requirements on every estimator in the table, and properties of each one.
#include "controller/estimation/estimator.hpp"

#include <memory>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "models/linear_algebra.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace estimator_test {

using namespace testing;

Eigen::Matrix3d noise() { return Eigen::Vector3d(0.02, 0.03, 0.005).asDiagonal(); }

Eigen::Matrix3d sensor() {
  Eigen::Matrix3d covariance = Eigen::Vector3d(0.04, 0.01, 0.02).asDiagonal();
  covariance(0, 2) = covariance(2, 0) = 0.01;
  return covariance;
}

EstimatorSettings settings_of(const models::Dynamics& car) {
  return {.dynamics = car, .noise_covariance = noise(), .sensor_covariance = sensor()};
}

TEST(Estimators, give_laws_that_depend_on_nothing_but_their_arguments) {
  const auto car = dubins_car();
  const Gaussian prior = dubins_belief();
  const Eigen::VectorXd seen = Eigen::Vector3d(0.1, -0.2, 0.3);
  const Eigen::VectorXd input = Eigen::VectorXd::Constant(1, 0.4);
  for (const EstimatorEntry& entry : estimators()) {
    SCOPED_TRACE(entry.name);
    const auto estimator = make_estimator(entry.name, settings_of(*car));
    const Gaussian first = estimator->predict(estimator->correct(prior, seen), input);
    (void)estimator->correct(prior, 2.0 * seen);
    const Gaussian second = estimator->predict(estimator->correct(prior, seen), input);
    EXPECT_EQ(first.mean, second.mean);
    EXPECT_EQ(first.covariance, second.covariance);
    EXPECT_NO_THROW(check_gaussian(first));
    EXPECT_EQ(first.covariance, first.covariance.transpose());
    // No coordinate is known better than the incoming noise allows.
    EXPECT_GE(models::symmetric_eigen(first.covariance - noise()).values.minCoeff(), -1e-15);
  }
}

TEST(Estimators, refuse_covariances_of_the_wrong_size) {
  const auto car = dubins_car();
  for (const EstimatorEntry& entry : estimators()) {
    EstimatorSettings settings = settings_of(*car);
    settings.sensor_covariance = Eigen::Matrix2d::Identity();
    EXPECT_THROW((void)make_estimator(entry.name, settings), std::invalid_argument);
  }
  EXPECT_THROW((void)make_estimator("kalmann", settings_of(*car)), std::invalid_argument);
}

TEST(ExactEstimator, takes_the_observation_for_the_state) {
  const auto car = dubins_car();
  const auto estimator = make_estimator("exact", settings_of(*car));
  const Eigen::VectorXd seen = Eigen::Vector3d(0.1, -0.2, 0.3);
  const Gaussian posterior = estimator->correct(dubins_belief(), seen);
  EXPECT_EQ(posterior.mean, seen);
  EXPECT_TRUE(posterior.covariance.isZero(0.0));
  EXPECT_EQ(estimator->predict(posterior, Eigen::VectorXd::Zero(1)).covariance, noise());
}

TEST(LastMeasurementEstimator, spreads_what_is_seen_as_the_linearised_step_does) {
  const auto car = dubins_car();
  const auto estimator = make_estimator("last_measurement", settings_of(*car));
  const Eigen::VectorXd seen = Eigen::Vector3d(0.1, -0.2, 0.3);
  const Eigen::VectorXd input = Eigen::VectorXd::Constant(1, 0.4);
  const Gaussian posterior = estimator->correct(dubins_belief(), seen);
  EXPECT_EQ(posterior.covariance, sensor());
  const Gaussian belief = estimator->predict(posterior, input);
  // By draws through the step itself; small ones, so that the step is nearly linear.
  constexpr double kSmall = 1e-3;
  const Eigen::MatrixXd root = models::cholesky_factor(sensor());
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  constexpr int kDraws = 200000;
  models::StateBatch states =
      (kSmall * root *
       models::StateBatch::NullaryExpr(3, kDraws, [&] { return normal(generator); }))
          .colwise() +
      seen;
  models::StateBatch next(3, kDraws);
  car->step(states, models::StateBatch(input.replicate(1, kDraws)), next);
  const Eigen::MatrixXd away = next.colwise() - belief.mean;
  const Eigen::MatrixXd carried = away * away.transpose() / (kSmall * kSmall * kDraws);
  EXPECT_LE((belief.covariance - noise() - carried).norm(), 0.01 * carried.norm());
}

}  // namespace estimator_test
}  // namespace qsmpc::controller
