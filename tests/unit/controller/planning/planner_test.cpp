#include "controller/planning/planner.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "controller/planning/cost/placed_target.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace planner_test {

using namespace testing;

/// 1.5 m/s along the x axis, up to x = 8.
PlannerSettings along_the_x_axis() {
  PlannerSettings settings = dubins_settings();
  const Eigen::Matrix2Xd line{{0.0, 5.0, 10.0}, {0.0, 0.0, 0.0}};
  settings.path = PathTarget{.path = std::make_shared<const ArcPath>(line, false),
                             .speed = SpeedProfile(1.5),
                             .time_step = 0.1,
                             .end = 8.0};
  return settings;
}

TEST(Planner, the_way_to_the_target_along_a_path_is_what_is_left_of_it) {
  const auto car = dubins_car();
  Planner planner(*car, along_the_x_axis());
  const Eigen::Vector3d state(3.0, 0.0, 0.0);
  EXPECT_EQ(planner.way_to_target(state, 3.0), 5.0);
  EXPECT_EQ(planner.way_to_target(state, 8.0), 0.0);
  EXPECT_EQ(planner.way_to_target(state, 9.0), 0.0) << "beyond its end";
}

TEST(Planner, has_a_target_for_each_stage_along_a_path) {
  const PlannerSettings settings = along_the_x_axis();
  QuadraticCost weights = settings.cost;
  place_target(settings, dubins_car()->description(), Eigen::Vector3d(2.0, 0.3, 0.0), 2.0, weights);
  ASSERT_EQ(weights.stage_targets.cols(), settings.horizon + 1);
  for (int k = 0; k <= settings.horizon; ++k) {
    EXPECT_NEAR(weights.stage_targets(0, k), 2.0 + 0.15 * k, 1e-9);
    EXPECT_NEAR(weights.stage_targets(1, k), 0.0, 1e-9);
  }
  EXPECT_EQ(weights.target, weights.stage_targets.rightCols<1>());
}

TEST(Planner, plan_is_consistent_with_itself) {
  const auto car = dubins_car();
  for (const bool closed_loop : {false, true}) {
    PlannerSettings settings = dubins_settings();
    settings.closed_loop = closed_loop;
    Planner planner(*car, settings);
    const Plan& plan = planner.plan(dubins_belief());
    ASSERT_EQ(plan.policy.horizon(), settings.horizon);
    ASSERT_EQ(plan.prediction.stages.size(), 6U);
    EXPECT_TRUE((plan.policy.inputs.array().abs() <= 2.0).all());
    EXPECT_EQ(plan.policy.states, nominal_states(*car, dubins_belief().mean, plan.policy.inputs));
    EXPECT_LE(plan.evaluations, settings.max_evaluations);
    EXPECT_FALSE(plan.fallback);
    EXPECT_EQ(plan.policy.gains[0].isZero(0.0), !closed_loop);
    // The last input only turns the heading, which costs nothing here.
    EXPECT_TRUE(plan.policy.gains[4].isZero(0.0));
    for (const DiscreteMeasure& stage : plan.prediction.stages) {
      EXPECT_NO_THROW(check_measure(stage));
      EXPECT_LE(stage.size(), 30);
    }
  }
}

TEST(Planner, turns_towards_the_target_and_lowers_the_cost) {
  const auto car = dubins_car();
  PlannerSettings settings = dubins_settings();
  settings.cost.target << 0.0, 5.0, 0.0;
  settings.max_evaluations = 1;
  Planner unoptimised(*car, settings);
  const double before = unoptimised.plan(dubins_belief()).cost.total();
  settings.max_evaluations = 100;
  Planner optimised(*car, settings);
  const Plan& plan = optimised.plan(dubins_belief());
  EXPECT_LE(plan.cost.total(), before);
  EXPECT_GT(plan.policy.inputs(0, 0), 1.0);  // the target is to the left, 90° off
}

TEST(Planner, given_gain_is_used) {
  const auto car = dubins_car();
  PlannerSettings settings = dubins_settings();
  settings.feedback_gain = Eigen::RowVector3d(0.1, -0.2, -0.3);
  Planner planner(*car, settings);
  for (const Eigen::MatrixXd& gain : planner.plan(dubins_belief()).policy.gains) {
    EXPECT_EQ(gain, *settings.feedback_gain);
  }
}

TEST(Planner, same_settings_and_beliefs_give_bitwise_equal_plans) {
  const auto car = dubins_car();
  Planner first(*car, dubins_settings());
  Planner second(*car, dubins_settings());
  Gaussian belief = dubins_belief();
  for (int step = 0; step < 4; ++step) {
    const Plan& one = first.plan(belief);
    const Plan& two = second.plan(belief);
    EXPECT_EQ(one.policy.inputs, two.policy.inputs);
    EXPECT_EQ(one.cost.total(), two.cost.total());
    EXPECT_EQ(one.evaluations, two.evaluations);
    EXPECT_EQ(one.prediction.stages.back().locations, two.prediction.stages.back().locations);
    belief.mean = one.policy.states.col(1);
    if (step == 2) belief.covariance *= 2.0;
  }
}

TEST(Planner, reset_makes_the_next_plan_a_first_plan) {
  const auto car = dubins_car();
  Planner planner(*car, dubins_settings());
  const Eigen::MatrixXd first = planner.plan(dubins_belief()).policy.inputs;
  Gaussian elsewhere = dubins_belief();
  elsewhere.mean << 3.0, 1.0, 2.0;
  (void)planner.plan(elsewhere);
  planner.reset();
  EXPECT_EQ(planner.plan(dubins_belief()).policy.inputs, first);
}

TEST(Planner, planning_again_from_the_same_belief_is_not_worse) {
  const auto car = dubins_car();
  Planner planner(*car, dubins_settings());
  const double first = planner.plan(dubins_belief()).cost.total();
  const double second = planner.plan(dubins_belief()).cost.total();
  // Both end in the single minimum of a free plane; rounds stop at a relative change of 1e-4.
  EXPECT_LE(second, first * (1.0 + 2e-4));
}

TEST(Planner, warm_start_lets_a_starved_solver_improve_from_plan_to_plan) {
  const auto car = dubins_car();
  PlannerSettings settings = dubins_settings();
  settings.cost.target << 2.0, 5.0, 0.0;
  settings.max_evaluations = 4;
  Planner starved(*car, settings);
  Gaussian belief = dubins_belief();
  for (int step = 0; step < 6; ++step) {
    const Plan& plan = starved.plan(belief);
    Planner cold(*car, settings);
    // The start is the better guess on the belief's points only: 1 % for the noise that it leaves
    // out.
    EXPECT_LE(plan.cost.total(), 1.01 * cold.plan(belief).cost.total()) << step;
    belief.mean = plan.policy.states.col(1);
  }
}

TEST(Planner, enormous_beliefs_give_a_status_and_no_exception) {
  const auto car = dubins_car();
  for (const char* propagator : {"compressed", "noise_free"}) {
    PlannerSettings settings = dubins_settings();
    settings.propagator = propagator;
    Planner planner(*car, settings);
    const Eigen::MatrixXd usual = planner.plan(dubins_belief()).policy.inputs;
    Gaussian far = dubins_belief();
    far.mean[0] = 1e200;
    const Plan& plan = planner.plan(far);
    EXPECT_EQ(plan.status, SolverStatus::kNumericalTrouble);
    EXPECT_TRUE(plan.fallback);
    EXPECT_EQ(plan.policy.inputs.leftCols(4), usual.rightCols(4));
    EXPECT_EQ(plan.policy.inputs(0, 4), usual(0, 4));
  }
}

TEST(Planner, broken_model_gives_a_status_and_no_exception_and_recovers) {
  FragileCar car;
  for (const char* propagator : {"compressed", "noise_free"}) {
    PlannerSettings settings = dubins_settings();
    settings.propagator = propagator;
    Planner planner(car, settings);
    car.broken = true;
    const Plan& first = planner.plan(dubins_belief());
    EXPECT_EQ(first.status, SolverStatus::kNumericalTrouble);
    EXPECT_FALSE(first.fallback) << "there is no previous plan to fall back on";
    EXPECT_TRUE(first.policy.inputs.allFinite());
    car.broken = false;
    const Eigen::MatrixXd healthy = planner.plan(dubins_belief()).policy.inputs;
    car.broken = true;
    const Plan& broken = planner.plan(dubins_belief());
    EXPECT_EQ(broken.status, SolverStatus::kNumericalTrouble);
    EXPECT_TRUE(broken.fallback);
    EXPECT_EQ(broken.policy.inputs.leftCols(4), healthy.rightCols(4));
    car.broken = false;
    const Plan& again = planner.plan(dubins_belief());
    EXPECT_FALSE(again.fallback);
    EXPECT_TRUE(std::isfinite(again.cost.total()));
  }
}

TEST(Planner, invalid_beliefs_are_refused_even_after_a_valid_one) {
  const auto car = dubins_car();
  Planner planner(*car, dubins_settings());
  (void)planner.plan(dubins_belief());
  const auto refused = [&](const std::function<void(Gaussian&)>& spoil) {
    Gaussian belief = dubins_belief();
    spoil(belief);
    EXPECT_THROW((void)planner.plan(belief), std::invalid_argument);
  };
  refused([](Gaussian& belief) { belief.mean[1] = std::nan(""); });
  refused([](Gaussian& belief) { belief.mean = Eigen::VectorXd::Zero(2); });
  refused([](Gaussian& belief) { belief.covariance = Eigen::MatrixXd::Identity(2, 2); });
  refused([](Gaussian& belief) { belief.covariance(0, 0) = -1.0; });
  refused([](Gaussian& belief) { belief.covariance(0, 1) = 0.005; });
  refused([](Gaussian& belief) { belief.covariance(0, 0) = std::nan(""); });
  EXPECT_NO_THROW((void)planner.plan(dubins_belief()));
}

TEST(Planner, invalid_settings_are_refused) {
  const auto car = dubins_car();
  const auto refused = [&](const char* says, const std::function<void(PlannerSettings&)>& spoil) {
    PlannerSettings settings = dubins_settings();
    spoil(settings);
    try {
      const Planner planner(*car, settings);
      ADD_FAILURE() << "not refused: " << says;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos)
          << error.what() << " does not say: " << says;
    }
  };
  const double nan = std::nan("");
  refused("the horizon must be at least 1", [](auto& s) { s.horizon = 0; });
  refused("at least one evaluation", [](auto& s) { s.max_evaluations = 0; });
  refused("one point is needed for the belief", [](auto& s) { s.state_points = 0; });
  refused("at least one cell and one part", [](auto& s) { s.noise_points = 0; });
  refused("at least one cell and one part", [](auto& s) { s.compressed_points = 0; });
  refused("oracle", [](auto& s) { s.solver = "oracle"; });
  refused("telepathy", [](auto& s) { s.propagator = "telepathy"; });
  refused("the noise covariance must be a finite matrix of 3 x 3",
          [](auto& s) { s.noise_covariance = Eigen::MatrixXd::Identity(2, 2); });
  refused("covariance", [](auto& s) { s.noise_covariance(0, 0) = -0.1; });
  refused("the state cost must be a finite", [&](auto& s) { s.cost.state(0, 0) = nan; });
  refused("the state cost must be symmetric", [](auto& s) { s.cost.state(0, 1) = 1.0; });
  refused("the terminal cost must be symmetric", [](auto& s) { s.cost.terminal(2, 1) = 1.0; });
  refused("the input cost must be a finite matrix of 1 x 1",
          [](auto& s) { s.cost.input = Eigen::MatrixXd::Ones(2, 2); });
  refused("the target must be a finite state", [&](auto& s) { s.cost.target[0] = nan; });
  refused("the target must be a finite state",
          [](auto& s) { s.cost.target = Eigen::VectorXd::Zero(2); });
  refused("length must be positive", [](auto& s) { s.penalty.length = 0.0; });
  refused("weights must not be negative", [](auto& s) { s.penalty.box = -1.0; });
  refused("weights must not be negative", [&](auto& s) { s.penalty.obstacle = nan; });
  refused("the safe set must have", [](auto& s) { s.safe_set = unbounded_safe_set(2); });
  refused("lower must be less than upper", [](auto& s) { s.safe_set.bounds.lower[0] = 13.0; });
  refused("the input bounds must be finite, lower < upper",
          [](auto& s) { s.bounds.lower[0] = 2.0; });
  refused("the input bounds must be finite, lower < upper",
          [](auto& s) { s.bounds.upper[0] = std::numeric_limits<double>::infinity(); });
  refused("the input bounds must be finite, lower < upper",
          [](auto& s) { s.bounds.lower = Eigen::VectorXd::Zero(2); });
  refused("the feedback gain must be",
          [](auto& s) { s.feedback_gain = Eigen::MatrixXd::Zero(3, 1); });
  EXPECT_NO_THROW(Planner(*car, dubins_settings()));
}

TEST(Planner, one_stage_and_one_point_suffice) {
  const auto car = dubins_car();
  PlannerSettings settings = dubins_settings();
  settings.horizon = 1;
  settings.state_points = 1;
  settings.noise_points = 1;
  settings.compressed_points = 1;
  Planner planner(*car, settings);
  for (int step = 0; step < 3; ++step) {
    const Plan& plan = planner.plan(dubins_belief());
    EXPECT_EQ(plan.prediction.stages.size(), 2U);
    EXPECT_TRUE(std::isfinite(plan.cost.total()));
  }
}

TEST(Planner, the_belief_is_quantised_by_the_chosen_quantiser) {
  const auto car = dubins_car();
  for (const QuantiserEntry& entry : quantisers()) {
    PlannerSettings settings = dubins_settings();
    settings.quantiser = entry.kind;
    Planner planner(*car, settings);
    const GaussianQuantisation& belief = planner.plan(dubins_belief()).belief;
    const GaussianQuantisation expected =
        quantise(dubins_belief(), settings.state_points, entry.kind);
    EXPECT_EQ(belief.w2, expected.w2) << entry.name;
    EXPECT_EQ(belief.measure.locations, expected.measure.locations) << entry.name;
  }
}

TEST(Planner, preparing_for_beliefs_changes_no_plan) {
  const auto car = dubins_car();
  PlannerSettings settings = dubins_settings();
  settings.quantiser = QuantiserKind::kLloyd;
  Planner prepared(*car, settings);
  prepared.prepare(settings.noise_covariance);
  Planner other(*car, settings);
  EXPECT_EQ(prepared.plan(dubins_belief()).policy.inputs,
            other.plan(dubins_belief()).policy.inputs);
  EXPECT_THROW(prepared.prepare(Eigen::MatrixXd::Identity(2, 2)), std::invalid_argument);
  EXPECT_THROW(prepared.prepare(-Eigen::MatrixXd::Identity(3, 3)), std::invalid_argument);
}

TEST(Planner, prescribes_given_inputs_without_optimising) {
  const auto car = dubins_car();
  Planner planner(*car, dubins_settings());
  const Eigen::MatrixXd inputs = Eigen::MatrixXd::Constant(1, 5, 0.3);
  const Plan& plan = planner.prescribe(dubins_belief(), inputs);
  EXPECT_EQ(plan.policy.inputs, inputs);
  EXPECT_EQ(plan.evaluations, 0);
  EXPECT_EQ(plan.prediction.stages.size(), 6U);
  // The optimised plan costs less: the prescribed one was evaluated, and not used as its start.
  const double prescribed = plan.cost.total();
  EXPECT_LT(planner.plan(dubins_belief()).cost.total(), prescribed);
}

TEST(Planner, improves_the_plan_of_another_planner_and_continues_from_it) {
  const auto car = dubins_car();
  PlannerSettings starved = dubins_settings();
  starved.max_evaluations = 2;
  Planner other(*car, starved);
  const Plan& start = other.plan(dubins_belief());
  Planner planner(*car, dubins_settings());
  const double before = planner.price(dubins_belief(), start).cost.total();
  const double after = planner.plan_from(dubins_belief(), start).cost.total();
  EXPECT_LT(after, before);
  // A free plane has a single minimum.
  EXPECT_NEAR(after, Planner(*car, dubins_settings()).plan(dubins_belief()).cost.total(),
              2e-4 * after);
  EXPECT_TRUE(planner.plan(dubins_belief()).warm);
}

TEST(Planner, improving_what_cannot_be_improved_leaves_it_as_it_is) {
  const auto car = dubins_car();
  Planner first(*car, dubins_settings());
  (void)first.plan(dubins_belief());
  const Plan& best = first.plan(dubins_belief());
  Planner second(*car, dubins_settings());
  EXPECT_LE(second.plan_from(dubins_belief(), best).cost.total(), best.cost.total());
  EXPECT_NEAR(second.plan_from(dubins_belief(), best).cost.total(), best.cost.total(),
              2e-4 * best.cost.total());
}

TEST(Planner, refuses_prescribed_inputs_that_it_could_not_apply) {
  const auto car = dubins_car();
  Planner planner(*car, dubins_settings());
  const Gaussian belief = dubins_belief();
  Eigen::MatrixXd inputs = Eigen::MatrixXd::Zero(1, 5);
  EXPECT_NO_THROW((void)planner.prescribe(belief, inputs));
  EXPECT_THROW((void)planner.prescribe(belief, inputs.leftCols(4)), std::invalid_argument);
  for (const double bad : {2.1, -2.1, std::nan("")}) {
    inputs(0, 3) = bad;
    EXPECT_THROW((void)planner.prescribe(belief, inputs), std::invalid_argument) << bad;
  }
}

}  // namespace planner_test
}  // namespace qsmpc::controller
