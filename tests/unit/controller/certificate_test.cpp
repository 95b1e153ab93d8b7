#include "controller/certification/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "controller/certification/smoothed_bound.hpp"
#include "controller/certification/unicycle_surrogate.hpp"
#include "tests/unit/controller/planner_fixture.hpp"

namespace qsmpc::testing {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<StageCertificate> certificates_of(const Planner& planner, const Gaussian& belief,
                                              const Plan& plan) {
  const PredictedMotion motion = motion_of(planner, belief, plan);
  return certify(motion, planner.settings().safe_set, error_budget(motion));
}

TEST(Certificate, known_example_has_the_known_figures) {
  // Belief N(0, 0.01 I), u = 0.3 open loop, safe set [−1, 12]², stage 8: the truth is 2.9e-4 (1e6
  // samples), C3 3.7e-3; two digits are known.
  const PlannerSettings settings = dubins_settings();
  const auto surrogates =
      unicycle_surrogates(*dubins_car()->unicycle(), dubins_belief(),
                          Eigen::VectorXd::Constant(8, 0.3), settings.noise_covariance);
  const GaussianSurrogate& last = surrogates.back();
  const double bound =
      smoothed_probability({.locations = last.law.mean, .weights = Eigen::VectorXd::Ones(1)},
                           last.law.covariance, settings.safe_set, last.radius);
  EXPECT_GE(bound, 2.9e-4);
  EXPECT_NEAR(bound, 3.7e-3, 0.1e-3);
}

TEST(Certificate, value_is_the_least_bound_and_names_it) {
  const auto car = dubins_car();
  for (const bool closed_loop : {false, true}) {
    PlannerSettings settings = dubins_settings();
    settings.closed_loop = closed_loop;
    settings.safe_set.obstacles.push_back({.lower = Eigen::Vector3d(0.4, -0.2, -kInfinity),
                                           .upper = Eigen::Vector3d(0.6, 0.4, kInfinity)});
    Planner planner(*car, settings);
    const Plan& plan = planner.plan(dubins_belief());
    const auto certificates = certificates_of(planner, dubins_belief(), plan);
    ASSERT_EQ(certificates.size(), 5U);
    double sum = 0.0;
    for (const StageCertificate& stage : certificates) {
      EXPECT_EQ(stage.value, std::min({stage.particles, stage.mixture, stage.surrogate}));
      const double named = stage.kind == "c1"   ? stage.particles
                           : stage.kind == "c2" ? stage.mixture
                                                : stage.surrogate;
      EXPECT_EQ(named, stage.value);
      EXPECT_GE(stage.unsafe_mass, 0.0);
      EXPECT_LE(stage.unsafe_mass, stage.particles + 1e-15);  // rounding of the weights' sum
      sum += stage.value;
    }
    EXPECT_DOUBLE_EQ(horizon_bound(certificates), std::min(1.0, sum));
    EXPECT_LT(certificates[0].surrogate, 1.0);
    if (closed_loop) {
      EXPECT_EQ(certificates[1].surrogate, 1.0);
    }
  }
}

TEST(Certificate, closed_loop_surrogate_is_silent_where_the_heading_is_restricted) {
  const auto car = dubins_car();
  const auto first_surrogate = [&](const PlannerSettings& settings) {
    Planner planner(*car, settings);
    const Plan& plan = planner.plan(dubins_belief());
    return certificates_of(planner, dubins_belief(), plan)[0].surrogate;
  };
  EXPECT_LT(first_surrogate(dubins_settings()), 1.0);
  PlannerSettings by_bounds = dubins_settings();
  by_bounds.safe_set.bounds.upper[2] = 3.0;
  EXPECT_EQ(first_surrogate(by_bounds), 1.0);
  PlannerSettings by_obstacle = dubins_settings();
  by_obstacle.safe_set.obstacles.push_back({.lower = Eigen::Vector3d(-kInfinity, -kInfinity, 0.5),
                                            .upper = Eigen::Vector3d(kInfinity, kInfinity, 0.6)});
  EXPECT_EQ(first_surrogate(by_obstacle), 1.0);
  by_obstacle.closed_loop = false;
  EXPECT_LT(first_surrogate(by_obstacle), 1.0);
}

TEST(ErrorBudget, follows_its_recursion) {
  const auto car = dubins_car();
  Planner planner(*car, dubins_settings());
  const Plan& plan = planner.plan(dubins_belief());
  const std::vector<StageBudget> budgets = error_budget(motion_of(planner, dubins_belief(), plan));
  ASSERT_EQ(budgets.size(), 6U);
  EXPECT_EQ(budgets[0].total, plan.belief.w2);
  double total = plan.belief.w2;
  for (std::size_t k = 0; k < 5; ++k) {
    const double lipschitz = car->lipschitz(plan.policy.gains[k]);
    const double noise = planner.propagator().noise_w2();
    total = std::sqrt(lipschitz * lipschitz * total * total + noise * noise) +
            plan.prediction.maps[k].compression_w2;
    EXPECT_NEAR(budgets[k + 1].total, total, 1e-13 * total);  // rounding
    EXPECT_EQ(budgets[k].lipschitz, lipschitz);
    const StageBudget& next = budgets[k + 1];
    EXPECT_GE(next.belief + next.noise + next.compression, next.total * (1.0 - 1e-13));
  }
}

TEST(ErrorBudget, without_a_lipschitz_constant_is_infinite_but_for_a_known_state) {
  const FragileCar car;
  PlannerSettings settings = dubins_settings();
  settings.state_points = 1;
  Planner planner(car, settings);
  Gaussian known = dubins_belief();
  known.covariance.setZero();
  const Plan& plan = planner.plan(known);
  const std::vector<StageBudget> budgets = error_budget(motion_of(planner, dubins_belief(), plan));
  EXPECT_EQ(budgets[0].total, 0.0);
  EXPECT_TRUE(std::isfinite(budgets[1].total));
  EXPECT_EQ(budgets[2].total, kInfinity);
  const auto certificates =
      certify(motion_of(planner, known, plan), planner.settings().safe_set, budgets);
  EXPECT_LT(certificates[0].mixture, 1e-6);  // one step from a known state, ten deviations inside
  EXPECT_EQ(certificates[1].value, 1.0);
}

TEST(Certificate, says_one_for_a_plan_of_a_broken_model) {
  FragileCar car;
  car.broken = true;
  for (const char* propagator : {"compressed", "noise_free"}) {
    PlannerSettings settings = dubins_settings();
    settings.propagator = propagator;
    Planner planner(car, settings);
    const Plan& plan = planner.plan(dubins_belief());
    for (const StageCertificate& stage : certificates_of(planner, dubins_belief(), plan)) {
      EXPECT_EQ(stage.value, 1.0);
    }
  }
}

}  // namespace
}  // namespace qsmpc::testing
