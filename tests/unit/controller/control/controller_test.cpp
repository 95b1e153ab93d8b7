// Requirements on every controller in the table, including new ones.
#include "controller/control/controller.hpp"

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "models/constants.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace controller_test {

using namespace testing;

struct Choice {
  std::string kind;
  ControllerSettings settings;
};

/// Every controller; "lqr" about both references.
std::vector<Choice> choices(const PlannerSettings& problem) {
  std::vector<Choice> all;
  for (const ControllerEntry& entry : controllers()) {
    for (const LqrAbout about : {LqrAbout::kPath, LqrAbout::kTarget}) {
      // A risk that the small room allows, whatever the method.
      all.push_back(
          {entry.name, {.problem = problem, .lqr_about = about, .chance = {.risk = 0.3}}});
    }
  }
  return all;
}

/// The inputs of some periods, each from a different state, observed with an error.
std::vector<Eigen::VectorXd> inputs_of(Controller& controller) {
  std::vector<Eigen::VectorXd> inputs;
  for (int k = 0; k < 4; ++k) {
    Gaussian belief = dubins_belief();
    belief.mean += 0.14 * k * Eigen::Vector3d(1.0, 0.3, 0.2);
    const Eigen::VectorXd seen = belief.mean + Eigen::Vector3d(0.05, -0.03, 0.02);
    inputs.push_back(
        controller.decide({.period = k, .time = 0.1 * k, .belief = belief, .observation = seen})
            .input);
  }
  return inputs;
}

TEST(Controllers, decide_within_the_bounds_and_the_same_after_a_reset) {
  const auto car = dubins_car();
  PlannerSettings problem = dubins_settings();
  problem.cost.target << 5.0, 0.2, 0.0;  // ahead: turns within the bounds
  for (const Choice& choice : choices(problem)) {
    SCOPED_TRACE(choice.kind);
    const auto controller = make_controller(choice.kind, *car, choice.settings);
    const std::vector<Eigen::VectorXd> first = inputs_of(*controller);
    controller->reset();
    EXPECT_EQ(inputs_of(*controller), first);
    EXPECT_EQ(inputs_of(*make_controller(choice.kind, *car, choice.settings)), first);
    for (const Eigen::VectorXd& input : first) {
      ASSERT_EQ(input.size(), 1);
      EXPECT_GE(input[0], -2.0);
      EXPECT_LE(input[0], 2.0);
    }
    EXPECT_NE(first.front(), first.back());
  }
}

TEST(Controllers, fill_exactly_the_parts_of_a_decision_that_the_table_lists) {
  const auto car = dubins_car();
  const Gaussian belief = dubins_belief();
  const Eigen::VectorXd seen = belief.mean;
  for (const Choice& choice : choices(dubins_settings())) {
    SCOPED_TRACE(choice.kind);
    const DecisionParts parts = controller_entry(choice.kind).parts(choice.settings);
    const auto controller = make_controller(choice.kind, *car, choice.settings);
    const Decision& decision = controller->decide({.belief = belief, .observation = seen});
    EXPECT_EQ(decision.policy != nullptr, parts.stages > 0);
    EXPECT_EQ(decision.particles.has_value(), parts.particles);
    EXPECT_EQ(decision.cost.has_value(), parts.cost);
    EXPECT_EQ(decision.status.has_value(), parts.status);
    if (decision.policy == nullptr) continue;
    EXPECT_EQ(decision.policy->horizon(), parts.stages);
    EXPECT_EQ(std::ssize(decision.policy->gains), parts.stages);
    EXPECT_EQ(decision.policy->states.col(0), belief.mean);
    EXPECT_EQ(policy_input(*decision.policy, 0, seen), decision.input);
    if (!decision.particles) continue;
    EXPECT_EQ(std::ssize(decision.particles->prediction.stages), parts.stages + 1);
  }
}

TEST(Controllers, refuse_situations_of_the_wrong_size_and_numbers_that_are_not_finite) {
  const auto car = dubins_car();
  const Gaussian good = dubins_belief();
  const Eigen::VectorXd seen = good.mean;
  const Gaussian small{.mean = Eigen::Vector2d::Zero(), .covariance = Eigen::Matrix2d::Identity()};
  Gaussian lost = good;
  lost.mean[1] = kNotANumber;
  Eigen::VectorXd blind = seen;
  blind[0] = kInfinity;
  for (const Choice& choice : choices(dubins_settings())) {
    SCOPED_TRACE(choice.kind);
    const auto controller = make_controller(choice.kind, *car, choice.settings);
    for (const Gaussian* belief : {&small, static_cast<const Gaussian*>(&lost)}) {
      EXPECT_THROW((void)controller->decide({.belief = *belief, .observation = seen}),
                   std::invalid_argument);
    }
    for (const Eigen::VectorXd& bad : {blind, Eigen::VectorXd(Eigen::VectorXd::Zero(2))}) {
      EXPECT_THROW((void)controller->decide({.belief = good, .observation = bad}),
                   std::invalid_argument);
    }
    EXPECT_TRUE(controller->decide({.belief = good, .observation = seen}).input.allFinite());
  }
}

TEST(Controllers, answer_a_model_that_breaks_with_an_input_within_the_bounds) {
  const Gaussian belief = dubins_belief();
  const Eigen::VectorXd seen = belief.mean;
  for (const Choice& choice : choices(dubins_settings())) {
    SCOPED_TRACE(choice.kind);
    FragileCar car;
    const auto controller = make_controller(choice.kind, car, choice.settings);
    const auto decide = [&]() -> const Decision& {
      return controller->decide({.belief = belief, .observation = seen});
    };
    (void)decide();
    car.broken = true;
    const Eigen::VectorXd input = decide().input;
    EXPECT_TRUE((input.array().abs() <= 2.0).all()) << input.transpose();
    car.broken = false;
    const Decision& again = decide();
    EXPECT_TRUE((again.input.array().abs() <= 2.0).all());
    EXPECT_NE(again.status, SolverStatus::kNumericalTrouble);
  }
}

TEST(Controllers, keep_to_a_deadline_that_has_passed) {
  const auto car = dubins_car();
  const Gaussian belief = dubins_belief();
  const Eigen::VectorXd seen = belief.mean;
  for (const Choice& choice : choices(dubins_settings())) {
    SCOPED_TRACE(choice.kind);
    const auto controller = make_controller(choice.kind, *car, choice.settings);
    const Decision& decision = controller->decide(
        {.belief = belief, .observation = seen, .deadline = std::chrono::steady_clock::now()});
    EXPECT_TRUE(decision.input.allFinite());
    EXPECT_EQ(decision.status.value_or(SolverStatus::kDeadline), SolverStatus::kDeadline);
    EXPECT_LE(decision.evaluations, 1);
  }
}

TEST(Controllers, that_are_not_known_are_answered_with_those_that_are) {
  const auto car = dubins_car();
  try {
    (void)make_controller("pid", *car, {.problem = dubins_settings()});
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    for (const ControllerEntry& entry : controllers()) {
      EXPECT_NE(std::string(error.what()).find(entry.name), std::string::npos) << error.what();
    }
  }
}

}  // namespace controller_test
}  // namespace qsmpc::controller
