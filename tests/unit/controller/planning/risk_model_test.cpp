// The smooth model of a plan's risk: its value at the plan it was built from, and its derivatives
// by inputs and gains.
#include "controller/planning/risk/risk_model.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "controller/planning/risk/risk_constraint.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace risk_model_test {

using namespace testing;

constexpr Eigen::Index kHorizon = 5;

/// A system among walls and a block, with a body, under a policy with gains.
struct Case {
  std::unique_ptr<const models::Dynamics> dynamics;
  Eigen::MatrixXd noise;
  SafeSet safe_set;
  Gaussian belief;
  Policy policy;
  Prediction none{};

  [[nodiscard]] PredictedMotion motion() const {
    return {.dynamics = *dynamics,
            .noise_covariance = noise,
            .belief = belief,
            .policy = policy,
            .prediction = none};
  }
};

Case make_case(const std::string& system, Generator& generator) {
  Case one;
  one.dynamics = models::make_dynamics(system, {}, 0.1);
  const int dim = one.dynamics->state_dim();
  const int inputs = one.dynamics->input_dim();
  const models::SystemDescription& description = one.dynamics->description();
  one.noise = 0.002 * Eigen::MatrixXd::Identity(dim, dim);
  one.belief = {.mean = 0.1 * random_matrix(generator, dim, 1),
                .covariance = 0.004 * Eigen::MatrixXd::Identity(dim, dim)};
  if (system == "bicycle") one.belief.mean[3] = 4.0;
  one.safe_set = unbounded_safe_set(dim);
  one.safe_set.bounds.lower[0] = -0.5;
  one.safe_set.bounds.upper[1] = 0.6;
  Box block = unbounded_safe_set(dim).bounds;
  block.lower.head(2) << 0.9, -1.0;
  block.upper.head(2) << 1.4, -0.3;
  one.safe_set.obstacles = {block};
  if (description.heading >= 0) {
    one.safe_set.body = {.discs = {{.radius = 0.1, .offset = {0.2, 0.05}}, {.radius = 0.15}},
                         .x = 0,
                         .y = 1,
                         .heading = 2};
  }
  one.policy.inputs =
      0.2 * random_matrix(generator, inputs, kHorizon).cwiseAbs() +
      0.5 * (description.input_lower + description.input_upper).replicate(1, kHorizon);
  one.policy.states = nominal_states(*one.dynamics, one.belief.mean, one.policy.inputs);
  one.policy.bounds = {.lower = description.input_lower, .upper = description.input_upper};
  one.policy.gains.assign(kHorizon, 0.3 * random_matrix(generator, inputs, dim));
  return one;
}

TEST(RiskModel, has_the_derivatives_that_it_says) {
  Generator generator(61);
  for (const char* system : {"dubins", "dubins_rk4", "bicycle", "double_integrator"}) {
    SCOPED_TRACE(system);
    const Case one = make_case(system, generator);
    const UnsafeSet unsafe(one.safe_set);
    RiskModel model(*one.dynamics, unsafe);
    const PredictedMotion motion = one.motion();
    model.hold(motion, affine_surrogates(motion));
    const int dim = one.dynamics->state_dim();
    const Eigen::Index inputs = one.policy.inputs.rows();
    const Eigen::VectorXd weights = random_matrix(generator, kHorizon, 1).cwiseAbs();
    for (const bool with_gains : {false, true}) {
      Eigen::VectorXd z = Eigen::VectorXd::Zero(inputs * (kHorizon + (with_gains ? dim : 0)));
      z.head(inputs * kHorizon) = one.policy.inputs.reshaped();
      if (with_gains) z.tail(inputs * dim) = 0.05 * random_matrix(generator, inputs * dim, 1);
      Eigen::VectorXd gradient = Eigen::VectorXd::Zero(z.size());
      EXPECT_GT(model.risks(z).minCoeff(), 0.0);
      model.add_gradient(weights, gradient);
      EXPECT_GT(gradient.norm(), 1e-9);
      for (Eigen::Index i = 0; i < z.size(); ++i) {
        constexpr double kStep = 1e-5;
        Eigen::VectorXd moved = z;
        moved[i] += kStep;
        const double high = weights.dot(model.risks(moved));
        moved[i] -= 2.0 * kStep;
        const double slope = (high - weights.dot(model.risks(moved))) / (2.0 * kStep);
        EXPECT_NEAR(gradient[i], slope, 1e-6 * gradient.norm() + 1e-11) << "entry " << i;
      }
    }
  }
}

// Regions far from the held plan are passed over until a plan may come near; not if the gains, and
// with them the covariances, change, if only by nothing.
TEST(RiskModel, knows_of_regions_that_only_another_plan_comes_near) {
  Generator generator(63);
  for (const char* system : {"dubins", "bicycle"}) {
    SCOPED_TRACE(system);
    Case one = make_case(system, generator);
    one.dynamics = models::make_dynamics(system, {}, 0.5);
    one.policy.states = nominal_states(*one.dynamics, one.belief.mean, one.policy.inputs);
    one.noise *= 1e-4;
    one.belief.covariance *= 1e-4;
    const UnsafeSet unsafe(one.safe_set);
    RiskModel model(*one.dynamics, unsafe);
    const PredictedMotion motion = one.motion();
    model.hold(motion, affine_surrogates(motion));
    const Eigen::Index inputs = one.policy.inputs.size();
    const Eigen::Index gains = one.policy.inputs.rows() * one.dynamics->state_dim();
    int silent = 0;
    int near = 0;
    for (int repetition = 0; repetition < 50; ++repetition) {
      Eigen::VectorXd z = Eigen::VectorXd::Zero(inputs + gains);
      z.head(inputs) = one.policy.inputs.reshaped() + random_matrix(generator, inputs, 1, 0.5);
      const Eigen::VectorXd all = model.risks(z);
      const Eigen::VectorXd passed_over = model.risks(z.head(inputs));
      for (Eigen::Index k = 0; k < kHorizon; ++k) {
        if (std::isinf(all[k])) {  // deep in the block
          EXPECT_EQ(passed_over[k], all[k]);
        } else {
          EXPECT_NEAR(passed_over[k], all[k], 1e-6 * all[k]) << k;
        }
        ++(all[k] < 1e-30 ? silent : near);
      }
    }
    EXPECT_GT(silent, 20);
    EXPECT_GT(near, 20);
  }
}

// Past a stage whose step cannot be linearised nothing is known of how gains act: they change
// neither the risk there nor its derivatives.
TEST(RiskModel, keeps_the_covariance_where_the_effect_of_gains_is_unknown) {
  Generator generator(64);
  for (const char* system : {"dubins", "double_integrator"}) {
    SCOPED_TRACE(system);
    const Case one = make_case(system, generator);
    const UnsafeSet unsafe(one.safe_set);
    const PredictedMotion motion = one.motion();
    std::vector<SurrogateStage> surrogates = affine_surrogates(motion);
    constexpr Eigen::Index kUnknown = 2;
    surrogates[kUnknown].transition.resize(0, 0);
    RiskModel model(*one.dynamics, unsafe);
    model.hold(motion, surrogates);
    const Eigen::Index inputs = one.policy.inputs.size();
    const Eigen::Index gains = one.policy.inputs.rows() * one.dynamics->state_dim();
    Eigen::VectorXd z(inputs + gains);
    z << one.policy.inputs.reshaped(), 0.1 * random_matrix(generator, gains, 1);
    const Eigen::VectorXd changed = model.risks(z);
    const Eigen::VectorXd plain = model.risks(z.head(inputs));
    EXPECT_NEAR(changed[kUnknown], plain[kUnknown], 1e-9 * plain[kUnknown]);
    EXPECT_GT(std::abs(changed[kUnknown - 1] - plain[kUnknown - 1]), 1e-6 * plain[kUnknown - 1]);
    model.risks(z);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(z.size());
    model.add_gradient(Eigen::VectorXd::Unit(kHorizon, kUnknown), gradient);
    EXPECT_GT(gradient.head(inputs).norm(), 0.0);
    EXPECT_EQ(gradient.tail(gains).norm(), 0.0);
  }
}

TEST(RiskModel, says_what_was_certified_of_the_plan_that_it_holds) {
  Generator generator(62);
  const Case one = make_case("dubins", generator);
  const UnsafeSet unsafe(one.safe_set);
  RiskModel model(*one.dynamics, unsafe);
  const PredictedMotion motion = one.motion();
  const SurrogateBounds bounds =
      surrogate_bounds(motion, unsafe, CertificateEffort::kLeast, run_in_turn);
  model.hold(motion, bounds.surrogates);
  std::vector<double> certified;
  for (const RegionProbability& stage : bounds.bounds) certified.push_back(stage.smooth);
  model.calibrate(certified);
  const Eigen::VectorXd z = one.policy.inputs.reshaped();
  const Eigen::VectorXd at_plan = model.risks(z);
  for (Eigen::Index k = 0; k < kHorizon; ++k) {
    EXPECT_NEAR(at_plan[k], certified[k], 1e-9 + 1e-6 * certified[k]);
  }
  // The plan advances: a stage's factors now apply to the stage before it.
  model.shift_factors();
  const Eigen::VectorXd shifted = model.risks(z);
  EXPECT_NE(shifted[0], at_plan[0]);
  model.forget_factors();
  EXPECT_NE(model.risks(z)[1], shifted[1]);
}

TEST(RiskConstraint, is_the_logarithm_of_the_risk_over_its_limit) {
  // The input of a period moves this car within the period, so that every limit has a slope.
  const auto car = models::make_dynamics("dubins_rk4", {{"speed", 1.5}}, 0.1);
  PlannerSettings settings = block_settings();
  settings.risk = {.first = 0.01, .stage = 0.05, .plan = 0.1};
  RiskConstraint constraint(*car, settings);
  ASSERT_EQ(constraint.count(), 2 + settings.horizon);
  Policy policy{.inputs = Eigen::MatrixXd::Constant(1, settings.horizon, 0.1),
                .states = {},
                .gains = {},
                .bounds = settings.bounds};
  policy.states = nominal_states(*car, dubins_belief().mean, policy.inputs);
  policy.gains.assign(settings.horizon, Eigen::MatrixXd::Zero(1, 3));
  PlanRisk risk;
  constraint.certify(dubins_belief(), policy, risk);
  ASSERT_EQ(risk.stages.size(), static_cast<std::size_t>(settings.horizon));
  EXPECT_FALSE(risk.kept);  // it heads straight for the block
  EXPECT_GT(risk.severity, 0.0);
  Eigen::VectorXd z = policy.inputs.reshaped();
  z.array() += 0.3;
  const Eigen::VectorXd values = constraint.values(z);
  EXPECT_NEAR(values[0] + std::log(0.01), values[1] + std::log(0.05), 1e-12);
  double sum = 0.0;
  for (int k = 0; k < settings.horizon; ++k) sum += 0.05 * std::exp(values[1 + k]);
  EXPECT_NEAR(0.1 * std::exp(values[settings.horizon + 1]), sum, 1e-12);
  constraint.set_margin(0.25);
  EXPECT_LT((constraint.values(z) - values).cwiseAbs().maxCoeff() - 0.25, 1e-12);
  const Eigen::VectorXd multipliers = Eigen::VectorXd::LinSpaced(constraint.count(), 0.5, 2.0);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(z.size());
  constraint.add_gradient(multipliers, gradient);
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    constexpr double kStep = 1e-6;
    Eigen::VectorXd moved = z;
    moved[i] += kStep;
    const double high = multipliers.dot(constraint.values(moved));
    moved[i] -= 2.0 * kStep;
    const double slope = (high - multipliers.dot(constraint.values(moved))) / (2.0 * kStep);
    EXPECT_NEAR(gradient[i], slope, 1e-5 * gradient.norm());
  }
  // A limit of 1 means no limit.
  constraint.set_limits({.first = 1.0, .plan = 0.5}, 0);
  EXPECT_EQ(constraint.count(), 1);
}

/// Open loop, straight on.
Policy straight_policy(const models::Dynamics& car, const PlannerSettings& settings,
                       const Gaussian& belief) {
  Policy policy{.inputs = Eigen::MatrixXd::Zero(1, settings.horizon),
                .states = {},
                .gains = {},
                .bounds = settings.bounds};
  policy.states = nominal_states(car, belief.mean, policy.inputs);
  policy.gains.assign(settings.horizon, Eigen::MatrixXd::Zero(1, 3));
  return policy;
}

TEST(RiskConstraint, counts_once_what_stays_unsafe_where_the_sum_exceeds_the_limit) {
  const auto car = dubins_car();
  PlannerSettings settings = block_settings();
  settings.safe_set = unbounded_safe_set(3);
  settings.safe_set.bounds.upper[1] = 0.5;  // beside the path
  settings.risk = {.plan = 0.1};
  RiskConstraint constraint(*car, settings);
  const Gaussian belief{.mean = Eigen::Vector3d::Zero(),
                        .covariance = Eigen::Vector3d(0.01, 0.04, 1e-4).asDiagonal()};
  const Policy policy = straight_policy(*car, settings, belief);
  PlanRisk by_sum;
  constraint.certify(belief, policy, by_sum);
  constraint.set_limits({.plan = 0.5 * by_sum.plan}, 0);
  PlanRisk risk;
  constraint.certify(belief, policy, risk);
  ASSERT_FALSE(risk.kept);
  EXPECT_EQ(risk.plan, by_sum.plan);
  EXPECT_TRUE(constraint.accept(belief, policy, risk));
  EXPECT_TRUE(risk.kept);
  EXPECT_LE(risk.severity, 0.0);
  EXPECT_LT(risk.plan, 0.5 * by_sum.plan);
  EXPECT_GE(risk.plan, *std::max_element(risk.stages.begin(), risk.stages.end()) - 1e-6);
  // Neither of them meets its limits by first entries.
  for (const RiskLimits& limits :
       {RiskLimits{.plan = 0.9 * risk.plan},
        RiskLimits{.stage = 0.5 * risk.stages.back(), .plan = 0.5 * by_sum.plan}}) {
    constraint.set_limits(limits, 0);
    PlanRisk exceeded;
    constraint.certify(belief, policy, exceeded);
    EXPECT_FALSE(constraint.accept(belief, policy, exceeded));
    EXPECT_FALSE(exceeded.kept);
    EXPECT_EQ(exceeded.plan, by_sum.plan);
  }
  // What was accepted says nothing of the plan whose risk is next written over it.
  constraint.set_limits({.plan = 0.5 * by_sum.plan}, 0);
  ASSERT_TRUE(risk.counted);
  constraint.certify(belief, policy, risk);
  EXPECT_FALSE(risk.kept);
  EXPECT_TRUE(constraint.accept(belief, policy, risk));
}

// Half of the limit is the aim; what is within the limit is accepted all the same.
TEST(RiskConstraint, leaves_a_reserve_that_a_plan_may_use) {
  const auto car = dubins_car();
  PlannerSettings settings = block_settings();
  settings.safe_set = unbounded_safe_set(3);
  settings.safe_set.bounds.upper[1] = 0.6;  // beside the path
  settings.risk = {.stage = 0.9, .plan = 0.9};
  settings.risk_reserve = 0.5;
  RiskConstraint constraint(*car, settings);
  const Gaussian belief{.mean = Eigen::Vector3d::Zero(),
                        .covariance = Eigen::Vector3d(0.01, 0.01, 1e-4).asDiagonal()};
  const Policy policy = straight_policy(*car, settings, belief);
  PlanRisk risk;
  constraint.certify(belief, policy, risk);
  const double plan = risk.plan;
  const auto judged = [&](const RiskLimits& limits, double reserve) {
    PlannerSettings set = settings;
    set.risk = limits;
    set.risk_reserve = reserve;
    RiskConstraint judge(*car, set);
    PlanRisk out;
    judge.certify(belief, policy, out);
    const bool aimed = out.kept;
    return std::pair(aimed, judge.accept(belief, policy, out));
  };
  using Pair = std::pair<bool, bool>;
  const double stage = *std::max_element(risk.stages.begin(), risk.stages.end());
  ASSERT_GT(stage, 1e-4);
  ASSERT_LT(plan, 0.4);
  EXPECT_EQ(judged({.plan = 1.9 * plan}, 0.5), Pair(false, true));
  EXPECT_EQ(judged({.plan = 1.9 * plan}, 0.0), Pair(true, true));
  EXPECT_EQ(judged({.plan = 2.1 * plan}, 0.5), Pair(true, true));
  EXPECT_EQ(judged({.stage = 1.9 * stage}, 0.5), Pair(false, true));
  EXPECT_EQ(judged({.stage = 2.1 * stage}, 0.5), Pair(true, true));
  EXPECT_EQ(judged({.stage = 0.9 * stage}, 0.5), Pair(false, false));
  // The next step's limit, of a mission's budget, has no reserve; nor has a limit of 1.
  EXPECT_EQ(judged({.first = 1.1 * risk.stages.front()}, 0.5), Pair(true, true));
  EXPECT_EQ(judged({.plan = 1.0}, 0.5), Pair(true, true));
  // Limits of a single plan are kept as they are, unless they are above the aim.
  constraint.set_limits({.stage = 1.1 * stage, .plan = 1.1 * plan}, 0);
  constraint.certify(belief, policy, risk);
  EXPECT_TRUE(risk.kept);
}

}  // namespace risk_model_test
}  // namespace qsmpc::controller
