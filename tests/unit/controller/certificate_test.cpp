#include "controller/certification/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/controller/planner_fixture.hpp"

namespace qsmpc::testing {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<StageCertificate> certificates_of(const Planner& planner, const Gaussian& belief,
                                              const Plan& plan) {
  const PredictedMotion motion = motion_of(planner, belief, plan);
  return certify(motion, planner.settings().safe_set, error_budget(motion));
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
