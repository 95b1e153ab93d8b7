// Given gains, and gains optimised together with the inputs.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace planner_gain_test {

using namespace testing;

// Both stop within this relative distance of their local minimum: the solver's tolerance is 1e-6
// per iteration, and a round of new assignments is worth 1e-5.
constexpr double kSettled = 1e-4;

PlannerSettings room_settings(double penalty) {
  PlannerSettings settings = dubins_settings();
  settings.max_evaluations = 400;
  settings.cost.target << 2.0, 1.0, 0.0;
  settings.penalty.obstacle = penalty;
  settings.safe_set.obstacles.push_back(
      Box{.lower = Eigen::Vector3d(0.3, 0.3, -1e9), .upper = Eigen::Vector3d(0.8, 0.9, 1e9)});
  return settings;
}

TEST(PlannerGain, optimised_gains_cost_no_more) {
  const auto car = dubins_car();
  int changed = 0;
  for (const double penalty : {0.0, 50.0, 400.0}) {
    for (const double target : {-1.0, 0.5, 2.0}) {
      PlannerSettings settings = room_settings(penalty);
      settings.cost.target[1] = target;
      Planner given(*car, settings);
      settings.optimise_gain = true;
      Planner optimised(*car, settings);
      Gaussian belief = dubins_belief();
      const Plan& plain = given.plan(belief);
      const Plan& plan = optimised.plan(belief);
      EXPECT_LE(plan.cost.total(), (1.0 + kSettled) * plain.cost.total()) << penalty << target;
      EXPECT_TRUE(plain.gain_change.isZero(0.0));
      changed += plan.gain_change.isZero(0.0) ? 0 : 1;
      // The reported change of the gains is the actual one.
      const Eigen::MatrixXd about = plan.policy.gains[0];
      settings.optimise_gain = false;
      Planner again(*car, settings);
      EXPECT_LE(
          (again.prescribe(belief, plan.policy.inputs).policy.gains[0] + plan.gain_change - about)
              .cwiseAbs()
              .maxCoeff(),
          1e-12);  // rounding
    }
  }
  EXPECT_GE(changed, 5);
}

TEST(PlannerGain, optimising_pays_where_the_given_gain_is_a_bad_one) {
  const auto car = dubins_car();
  PlannerSettings settings = room_settings(400.0);
  settings.feedback_gain = Eigen::RowVector3d(0.5, 2.0, 4.0);  // away from the path
  Planner given(*car, settings);
  settings.optimise_gain = true;
  Planner optimised(*car, settings);
  const double with = optimised.plan(dubins_belief()).cost.total();
  EXPECT_LT(with, 0.999 * given.plan(dubins_belief()).cost.total());
}

TEST(PlannerGain, warm_starts_keep_the_gain_that_was_found) {
  const auto car = dubins_car();
  PlannerSettings settings = room_settings(200.0);
  settings.optimise_gain = true;
  Planner planner(*car, settings);
  Gaussian belief = dubins_belief();
  for (int step = 0; step < 4; ++step) {
    const Plan& plan = planner.plan(belief);
    EXPECT_EQ(plan.warm, step > 0);
    Planner cold(*car, settings);
    // A local minimum other than the cold start's may be slightly worse, as elsewhere.
    EXPECT_LE(plan.cost.total(), 1.02 * cold.plan(belief).cost.total()) << step;
    belief.mean = plan.policy.states.col(1);
  }
}

TEST(PlannerGain, any_number_of_evaluations_is_enough_for_a_plan) {
  const auto car = dubins_car();
  PlannerSettings settings = room_settings(400.0);
  settings.optimise_gain = true;
  for (int evaluations = 1; evaluations <= 60; ++evaluations) {
    settings.max_evaluations = evaluations;
    Planner planner(*car, settings);
    Gaussian belief = dubins_belief();
    for (int step = 0; step < 2; ++step) {
      const Plan& plan = planner.plan(belief);
      EXPECT_LE(plan.evaluations, evaluations);
      EXPECT_TRUE(std::isfinite(plan.cost.total())) << evaluations;
      belief.mean = plan.policy.states.col(1);
    }
  }
}

TEST(PlannerGain, open_loop_has_nothing_to_optimise) {
  const auto car = dubins_car();
  PlannerSettings settings = room_settings(400.0);
  settings.closed_loop = false;
  Planner plain(*car, settings);
  settings.optimise_gain = true;
  Planner planner(*car, settings);
  const Plan& plan = planner.plan(dubins_belief());
  EXPECT_TRUE(plan.gain_change.isZero(0.0));
  EXPECT_EQ(plan.policy.inputs, plain.plan(dubins_belief()).policy.inputs);
}

}  // namespace planner_gain_test
}  // namespace qsmpc::controller
