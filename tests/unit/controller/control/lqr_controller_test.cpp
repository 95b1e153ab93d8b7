// The regulator compared with closed forms, and the nominal controller with the equivalent planner.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "controller/control/controller.hpp"
#include "controller/planning/planner.hpp"
#include "controller/prediction/policy.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace lqr_controller_test {

using namespace testing;

/// The double integrator about its origin, with bounds too wide to be active.
struct Integrator {
  std::unique_ptr<const models::Dynamics> dynamics =
      models::make_dynamics("double_integrator", {}, 0.1);
  PlannerSettings problem;
  Gaussian belief;

  Integrator() {
    const int states = dynamics->state_dim();
    const int inputs = dynamics->input_dim();
    problem.horizon = 12;
    problem.noise_covariance = Eigen::MatrixXd::Zero(states, states);
    problem.cost = {.state = Eigen::MatrixXd::Identity(states, states),
                    .input = 0.05 * Eigen::MatrixXd::Identity(inputs, inputs),
                    .terminal = 3.0 * Eigen::MatrixXd::Identity(states, states),
                    .target = Eigen::VectorXd::Zero(states)};
    problem.safe_set = unbounded_safe_set(states);
    problem.bounds = {.lower = Eigen::VectorXd::Constant(inputs, -1e6),
                      .upper = Eigen::VectorXd::Constant(inputs, 1e6)};
    belief = {.mean = Eigen::VectorXd::LinSpaced(states, 0.5, -1.5),
              .covariance = 0.01 * Eigen::MatrixXd::Identity(states, states)};
  }

  [[nodiscard]] Decision decide(LqrAbout about) const {
    const auto controller =
        make_controller("lqr", *dynamics, {.problem = problem, .lqr_about = about});
    Decision decision;
    decision.input = controller->decide({.belief = belief, .observation = belief.mean}).input;
    return decision;
  }
  [[nodiscard]] LqrWeights weights() const {
    return {.state = problem.cost.state,
            .input = 2.0 * problem.cost.input,
            .terminal = 2.0 * problem.cost.terminal};
  }
  [[nodiscard]] Eigen::MatrixXd first_gain(int stages) const {
    return lqr_gains(*dynamics, Eigen::MatrixXd::Zero(dynamics->state_dim(), stages + 1),
                     Eigen::MatrixXd::Zero(dynamics->input_dim(), stages), weights())
        .front();
  }
};

TEST(LqrController, about_the_path_is_the_finite_horizons_regulator_where_all_is_linear) {
  const Integrator integrator;
  const Eigen::VectorXd expected =
      integrator.first_gain(integrator.problem.horizon) * integrator.belief.mean;
  EXPECT_LE((integrator.decide(LqrAbout::kPath).input - expected).norm(), 1e-9 * expected.norm());
}

TEST(LqrController, about_the_target_solves_the_algebraic_riccati_equation) {
  const Integrator integrator;
  const Eigen::VectorXd expected = integrator.first_gain(3000) * integrator.belief.mean;
  EXPECT_LE((integrator.decide(LqrAbout::kTarget).input - expected).norm(), 1e-8 * expected.norm());
}

TEST(LqrController, improves_its_path_until_no_input_is_worth_a_change) {
  const auto car = dubins_car();
  PlannerSettings problem = dubins_settings();
  problem.horizon = 10;
  const auto controller = make_controller("lqr", *car, {.problem = problem});
  const Gaussian belief = dubins_belief();
  const Eigen::VectorXd seen = belief.mean;
  const Decision& decision = controller->decide({.belief = belief, .observation = seen});
  ASSERT_EQ(decision.status, SolverStatus::kConverged);
  const auto cost_of = [&](const Eigen::MatrixXd& inputs) {
    const Eigen::MatrixXd states = nominal_states(*car, belief.mean, inputs);
    double cost = 0.0;
    for (Eigen::Index k = 0; k <= inputs.cols(); ++k) {
      const Eigen::VectorXd away = states.col(k) - problem.cost.target;
      cost += k < inputs.cols() ? 0.5 * away.dot(problem.cost.state * away) +
                                      inputs.col(k).dot(problem.cost.input * inputs.col(k))
                                : away.dot(problem.cost.terminal * away);
    }
    return cost;
  };
  const Eigen::MatrixXd inputs = decision.policy->inputs;
  const double best = cost_of(inputs);
  EXPECT_NEAR(decision.cost->total(), best, 1e-12 * best);
  EXPECT_LT(best, 0.96 * cost_of(Eigen::MatrixXd::Zero(1, 10)));
  for (Eigen::Index k = 0; k < inputs.cols(); ++k) {
    for (const double change : {-0.02, 0.02}) {
      Eigen::MatrixXd other = inputs;
      other(0, k) = std::fmin(2.0, std::fmax(-2.0, other(0, k) + change));
      EXPECT_GE(cost_of(other), best * (1.0 - 1e-5)) << k;
    }
  }
}

TEST(LqrController, takes_the_turn_of_a_target_angle_that_is_nearest) {
  const auto car = dubins_car();
  PlannerSettings problem = dubins_settings();
  problem.cost.state = Eigen::Matrix3d::Identity();
  problem.cost.terminal = Eigen::Matrix3d::Identity();
  problem.cost.target = Eigen::Vector3d(50.0, 0.0, 2.0 * M_PI);
  problem.cost.angles = {2};
  const Gaussian belief = dubins_belief();
  for (const LqrAbout about : {LqrAbout::kPath, LqrAbout::kTarget}) {
    const Eigen::VectorXd seen = belief.mean;
    const auto controller = make_controller("lqr", *car, {.problem = problem, .lqr_about = about});
    EXPECT_NEAR(controller->decide({.belief = belief, .observation = seen}).input[0], 0.0, 1e-9);
  }
}

TEST(NominalController, does_not_feel_the_noise) {
  const auto car = dubins_car();
  PlannerSettings calm = block_settings();
  calm.noise_covariance *= 1e-6;
  const Gaussian belief = dubins_belief();
  const Eigen::VectorXd seen = belief.mean;
  const auto plan = [&](const char* kind, const PlannerSettings& problem) {
    const auto controller = make_controller(kind, *car, {.problem = problem});
    return Eigen::MatrixXd(
        controller->decide({.belief = belief, .observation = seen}).policy->inputs);
  };
  EXPECT_EQ(plan("nominal", block_settings()), plan("nominal", calm));
  EXPECT_NE(plan("quantised", block_settings()), plan("quantised", calm));
}

}  // namespace lqr_controller_test
}  // namespace qsmpc::controller
