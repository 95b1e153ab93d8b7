// The planner compared with plain predictions and costs: its own figures of its plan, and that no
// simpler plan is better.
#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "controller/planning/planner.hpp"
#include "tests/support/plain_planner.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace planner_truth_test {

using namespace testing;

struct Case {
  const char* name;
  bool closed_loop;
  bool blocks;
};

class PlannerTruth : public ::testing::TestWithParam<Case> {
 protected:
  PlannerTruth() : settings_(GetParam().blocks ? block_settings() : dubins_settings()) {
    settings_.closed_loop = GetParam().closed_loop;
    settings_.max_evaluations = 1000;
  }

  /// The cost of the policy of `plan` with other inputs and the same gains, predicted and summed
  /// plainly.
  [[nodiscard]] PlainCost plain_cost_of(const Plan& plan, const Eigen::MatrixXd& inputs) const {
    Policy policy = plan.policy;
    policy.inputs = inputs;
    for (Eigen::Index k = 0; k < inputs.cols(); ++k) {
      models::StateBatch next(policy.states.rows(), 1);
      car_->step(models::StateBatch(policy.states.col(k)), models::StateBatch(inputs.col(k)), next);
      policy.states.col(k + 1) = next.col(0);
    }
    const PlainPrediction prediction = plain_predict(*car_, plan.belief.measure, policy,
                                                     {.covariance = settings_.noise_covariance,
                                                      .cells = settings_.compressed_points,
                                                      .parts = settings_.noise_points});
    const HorizonCostTerms terms{.dynamics = *car_,
                                 .safe_set = settings_.safe_set,
                                 .cost = settings_.cost,
                                 .penalty = settings_.penalty,
                                 .noise_covariance = settings_.noise_covariance,
                                 .within_covariance = plan.belief.within_covariance};
    return plain_cost(terms, prediction, policy, inputs,
                      Eigen::MatrixXd::Zero(inputs.rows(), policy.states.rows()),
                      settings_.closed_loop);
  }

  const std::unique_ptr<const models::Dynamics> car_ = dubins_car();
  PlannerSettings settings_;
};

TEST_P(PlannerTruth, a_plan_costs_what_plain_sums_say) {
  Planner planner(*car_, settings_);
  const Plan& plan = planner.plan(dubins_belief());
  const PlainCost plain = plain_cost_of(plan, plan.policy.inputs);
  ASSERT_GT(plan.cost.total(), 1.0);
  EXPECT_NEAR(plan.cost.total(), plain.parts.total(), 1e-9 * plain.parts.total());
  EXPECT_EQ(plain.parts.of("obstacle") > 0.0, GetParam().blocks);
}

TEST_P(PlannerTruth, no_step_down_the_plain_slope_is_better) {
  Planner planner(*car_, settings_);
  const Plan& plan = planner.plan(dubins_belief());
  const Eigen::MatrixXd& inputs = plan.policy.inputs;
  const PlainCost plain = plain_cost_of(plan, inputs);
  const double steepest = plain.input_gradient.cwiseAbs().maxCoeff();
  ASSERT_GT(steepest, 0.0);
  for (const double move : {1e-3, 1e-2, 0.05, 0.2, 0.5}) {
    const Eigen::MatrixXd beside = (inputs - move / steepest * plain.input_gradient)
                                       .cwiseMax(settings_.bounds.lower[0])
                                       .cwiseMin(settings_.bounds.upper[0]);
    EXPECT_GE(plain_cost_of(plan, beside).parts.total(), (1.0 - 1e-4) * plan.cost.total()) << move;
  }
}

TEST_P(PlannerTruth, nothing_on_a_grid_is_better) {
  Planner planner(*car_, settings_);
  const Plan& plan = planner.plan(dubins_belief());
  Planner other(*car_, settings_);
  constexpr int kLevels = 5;
  constexpr int kStretches = 3;
  constexpr int kAll = 125;
  double best = std::numeric_limits<double>::infinity();
  double worst = 0.0;
  for (int number = 0; number < kAll; ++number) {
    Eigen::MatrixXd inputs(1, settings_.horizon);
    for (int k = 0; k < settings_.horizon; ++k) {
      int digit = number;
      for (int n = kStretches * k / settings_.horizon; n > 0; --n) digit /= kLevels;
      inputs(0, k) = -2.0 + 4.0 / (kLevels - 1) * (digit % kLevels);
    }
    // With the gains that these inputs imply.
    const double cost =
        plain_cost_of(other.prescribe(dubins_belief(), inputs), inputs).parts.total();
    best = std::min(best, cost);
    worst = std::max(worst, cost);
  }
  EXPECT_GT(worst, 1.05 * plan.cost.total()) << "or else the inputs do not matter";
  // No slope accounts for gains following the inputs: they are recomputed between the rounds of a
  // search.
  const double left = settings_.closed_loop ? 0.005 : 0.0;
  EXPECT_GE(best, (1.0 - left) * plan.cost.total());
}

INSTANTIATE_TEST_SUITE_P(of, PlannerTruth,
                         ::testing::Values(Case{"open_loop_in_a_room", false, false},
                                           Case{"closed_loop_in_a_room", true, false},
                                           Case{"open_loop_past_a_block", false, true},
                                           Case{"closed_loop_past_a_block", true, true}),
                         [](const auto& each) { return each.param.name; });

}  // namespace planner_truth_test
}  // namespace qsmpc::controller
