#include "controller/planning/start/first_guess.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "controller/planning/planner.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace first_guess_test {

using namespace testing;

/// The planner's comparison of first guesses, in isolation.
class Guesses {
 public:
  Guesses(const models::Dynamics& dynamics, const PlannerSettings& settings)
      : settings_(settings),
        policies_(dynamics, settings_),
        cost_(settings_.horizon, {.dynamics = dynamics,
                                  .safe_set = settings_.safe_set,
                                  .cost = settings_.cost,
                                  .penalty = settings_.penalty,
                                  .noise_covariance = zero_,
                                  .within_covariance = zero_}),
        guess_(settings_) {}

  bool compare(const Gaussian& belief, const Eigen::MatrixXd* previous) {
    cost_.place(belief);
    return guess_.compare(previous, no_change_, cost_, policies_);
  }
  [[nodiscard]] const FirstGuess& guess() const { return guess_; }
  [[nodiscard]] double evaluate(const Eigen::MatrixXd& inputs) {
    return cost_.evaluate(inputs, no_change_, policies_);
  }

 private:
  PlannerSettings settings_;
  Eigen::MatrixXd zero_ = Eigen::MatrixXd::Zero(3, 3);
  Eigen::MatrixXd no_change_ = Eigen::MatrixXd::Zero(1, 3);
  PolicyMaker policies_;
  NoiseFreeCost cost_;
  FirstGuess guess_;
};

TEST(FirstGuess, compares_the_shifted_plan_with_the_cheapest_constant) {
  const auto car = dubins_car();
  const PlannerSettings settings = block_settings();
  Guesses guesses(*car, settings);
  const Gaussian belief = dubins_belief();
  EXPECT_FALSE(guesses.compare(belief, nullptr));
  const Eigen::MatrixXd constant = guesses.guess().constant();
  for (const double share : {-0.9, -0.45, 0.0, 0.45, 0.9}) {
    const Eigen::MatrixXd other =
        Eigen::MatrixXd::Constant(1, settings.horizon, share * settings.bounds.upper[0]);
    EXPECT_LE(guesses.evaluate(constant), guesses.evaluate(other)) << share;
  }
  Eigen::MatrixXd previous = Eigen::MatrixXd::Zero(1, settings.horizon);
  previous(0, 1) = 0.7;
  EXPECT_TRUE(guesses.compare(belief, &previous));
  EXPECT_EQ(guesses.guess().shifted()(0, 0), 0.7);
  EXPECT_EQ(guesses.guess().advantage(),
            guesses.evaluate(guesses.guess().shifted()) - guesses.evaluate(constant));
  FragileCar broken;
  broken.broken = true;
  EXPECT_FALSE(Guesses(broken, settings).compare(belief, &previous));
}

// A target beside a wall: without noise, a careful plan costs more than a careless constant input.
TEST(FirstGuess, a_plan_that_is_careful_because_of_the_noise_is_continued) {
  const auto car = dubins_car();
  PlannerSettings settings = block_settings();
  settings.safe_set.bounds.lower[1] = -0.8;
  settings.cost.target << 6.0, -0.7, 0.0;
  settings.cost.terminal(1, 1) = 400.0;
  settings.penalty.box = 5e4;
  settings.penalty.length = 0.1;
  Planner planner(*car, settings);
  Guesses guesses(*car, settings);
  Gaussian belief = dubins_belief();
  const Plan* plan = &planner.plan(belief);
  int doubts = 0;
  for (int period = 0; period < 12; ++period) {
    const Eigen::MatrixXd previous = plan->policy.inputs;
    belief.mean = plan->policy.states.col(1);
    EXPECT_TRUE(guesses.compare(belief, &previous));
    const double shifted = guesses.evaluate(guesses.guess().shifted());
    if (clearly_cheaper(shifted - guesses.guess().advantage(), shifted)) ++doubts;
    plan = &planner.plan(belief);
    EXPECT_TRUE(plan->warm) << period;
  }
  EXPECT_GE(doubts, 6);
}

TEST(FirstGuess, a_plan_that_leads_into_a_block_is_given_up) {
  const auto car = dubins_car();
  const PlannerSettings settings = block_settings();
  Planner planner(*car, settings);
  Gaussian below = dubins_belief();
  below.mean << 0.0, -0.2, 0.0;
  (void)planner.plan(below);
  Gaussian above = below;
  above.mean << 0.3, 0.35, 0.3;
  const Plan& plan = planner.plan(above);
  EXPECT_FALSE(plan.warm);
  Planner other(*car, settings);
  EXPECT_LE(plan.cost.total(), other.plan(above).cost.total());
}

}  // namespace first_guess_test
}  // namespace qsmpc::controller
