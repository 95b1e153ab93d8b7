// The chance constraints of the literature, checked against their sources' statements.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <boost/math/distributions/binomial.hpp>
#include <gtest/gtest.h>

#include "controller/chance/chance_constraint.hpp"
#include "controller/chance/chance_planner.hpp"
#include "controller/chance/scenario.hpp"
#include "controller/chance/smoothed_tail.hpp"
#include "models/constants.hpp"
#include "models/random/random_numbers.hpp"

namespace qsmpc::controller {
namespace chance_constraints_test {

constexpr double kTimeStep = 0.5;
constexpr double kWall = 2.0;

std::unique_ptr<const models::Dynamics> cart() {
  return models::make_dynamics("double_integrator", {}, kTimeStep);
}

/// Aims beyond the wall at x = 2 and may approach it as far as the constraint allows.
ChancePlannerSettings wall_settings(const std::string& constraint) {
  ChancePlannerSettings settings;
  PlannerSettings& problem = settings.problem;
  problem.horizon = 3;
  problem.closed_loop = false;
  problem.noise_covariance = Eigen::Vector2d(0.01, 0.02).asDiagonal();
  problem.cost = {.state = Eigen::Vector2d(1.0, 0.1).asDiagonal(),
                  .input = Eigen::MatrixXd::Constant(1, 1, 0.01),
                  .terminal = Eigen::Vector2d(5.0, 0.1).asDiagonal(),
                  .target = Eigen::Vector2d(3.0, 0.0)};
  problem.safe_set = unbounded_safe_set(2);
  problem.safe_set.bounds.upper[0] = kWall;
  problem.bounds = {.lower = Eigen::VectorXd::Constant(1, -20.0),
                    .upper = Eigen::VectorXd::Constant(1, 20.0)};
  settings.constraint = constraint;
  settings.chance.risk = 0.05;
  return settings;
}

Gaussian cart_belief() {
  return {.mean = Eigen::Vector2d(0.5, 0.0), .covariance = 0.02 * Eigen::Matrix2d::Identity()};
}

/// Mean and standard deviation of the position at a stage, from the plan's inputs and gains.
struct Position {
  double mean;
  double deviation;
};

std::vector<Position> positions(const models::Dynamics& dynamics, const Policy& policy,
                                const Eigen::MatrixXd& noise) {
  std::vector<Position> all;
  Eigen::MatrixXd covariance = cart_belief().covariance;
  Eigen::MatrixXd a(2, 2);
  Eigen::MatrixXd b(2, 1);
  for (Eigen::Index k = 0; k < policy.horizon(); ++k) {
    dynamics.jacobians(policy.states.col(k), policy.inputs.col(k), a, b);
    const Eigen::MatrixXd closed = a + b * policy.gains[k];
    covariance = closed * covariance * closed.transpose() + noise;
    all.push_back({policy.states(0, k + 1), std::sqrt(covariance(0, 0))});
  }
  return all;
}

TEST(Cone, is_exact_for_a_linear_system_and_a_wall) {
  const auto system = cart();
  for (const bool closed : {false, true}) {
    ChancePlannerSettings settings = wall_settings("cone");
    settings.problem.closed_loop = closed;
    ChancePlanner planner(*system, settings);
    const ChancePlan& plan = planner.plan(cart_belief(), 0);
    EXPECT_EQ(plan.violation, 0.0);
    double most = 0.0;
    for (const Position& at : positions(*system, plan.policy, settings.problem.noise_covariance)) {
      most = std::max(most, 0.5 * std::erfc((kWall - at.mean) / at.deviation / std::sqrt(2.0)));
    }
    // The probability beyond the wall at the closest stage: the limit is kept and used up.
    EXPECT_LE(most, settings.chance.risk);
    EXPECT_GT(most, 0.97 * settings.chance.risk);
  }
}

TEST(Cantelli, is_attained_by_the_law_on_two_points) {
  const auto system = cart();
  ChancePlannerSettings settings = wall_settings("cantelli");
  settings.chance.risk = 0.1;
  ChancePlanner planner(*system, settings);
  const ChancePlan& plan = planner.plan(cart_belief(), 0);
  const double risk = settings.chance.risk;
  double nearest = kInfinity;
  for (const Position& at : positions(*system, plan.policy, settings.problem.noise_covariance)) {
    // With probability δ at the wall, else where mean and variance come out right.
    const double up = std::sqrt((1.0 - risk) / risk) * at.deviation;
    const double down = -std::sqrt(risk / (1.0 - risk)) * at.deviation;
    EXPECT_NEAR(risk * up + (1.0 - risk) * down, 0.0, 1e-12);
    EXPECT_NEAR(risk * up * up + (1.0 - risk) * down * down, at.deviation * at.deviation, 1e-12);
    nearest = std::min(nearest, kWall - at.mean - up);
  }
  EXPECT_GE(nearest, 0.0);
  EXPECT_LT(nearest, 2e-3);  // m
}

TEST(ScenarioSamples, are_the_least_that_the_bound_allows) {
  for (const int decisions : {1, 3, 8, 18}) {
    for (const double risk : {0.01, 0.1, 0.3}) {
      const int samples = scenario_samples(risk, 0.9, decisions);
      const auto tail = [&](int n) {
        double sum = 0.0;  // Σ_{i < decisions} C(n, i) riskⁱ (1 − risk)^(n − i)
        for (int i = 0; i < decisions; ++i) {
          sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) +
                          i * std::log(risk) + (n - i) * std::log1p(-risk));
        }
        return sum;
      };
      EXPECT_LE(tail(samples), 0.1 + 1e-12);
      EXPECT_GT(tail(samples - 1), 0.1);
    }
  }
}

TEST(Scenario, violates_no_more_often_than_its_bound_over_1000_draws) {
  const auto system = cart();
  ChancePlannerSettings settings = wall_settings("scenario");
  settings.problem.horizon = 2;
  settings.chance.risk = 0.2;
  settings.chance.confidence = 0.9;
  ChancePlanner planner(*system, settings);
  const Eigen::Index samples = planner.paths();
  EXPECT_EQ(samples, scenario_samples(0.2, 0.9, 2));
  // Fresh paths; only the noise's contribution to the positions is needed, as the system is linear.
  constexpr Eigen::Index kFresh = 4000;
  Points away(2, kFresh);
  for (Eigen::Index i = 0; i < kFresh; ++i) {
    const Eigen::VectorXd n =
        models::standard_normal_sample(6, {.seed = 99, .episode = static_cast<std::uint64_t>(i)});
    Eigen::Vector2d x = std::sqrt(0.02) * n.head<2>();
    for (int k = 0; k < 2; ++k) {
      x = Eigen::Vector2d(x[0] + kTimeStep * x[1], x[1]) +
          Eigen::Vector2d(std::sqrt(0.01) * n[2 + 2 * k], std::sqrt(0.02) * n[3 + 2 * k]);
      away(k, i) = x[0];
    }
  }
  constexpr int kDraws = 1000;
  int above = 0;
  double sum = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    planner.reset(static_cast<std::uint64_t>(draw));
    const Policy& policy = planner.plan(cart_belief(), 0).policy;
    const auto unsafe = (away.row(0).array() + policy.states(0, 1) >= kWall) ||
                        (away.row(1).array() + policy.states(0, 2) >= kWall);
    const double violation = unsafe.cast<double>().mean();
    sum += violation;
    if (violation > settings.chance.risk) ++above;
  }
  // Of 1000 draws, no more exceed δ than the confidence allows, with probability 99.9 %.
  const boost::math::binomial most(kDraws, 1.0 - settings.chance.confidence);
  EXPECT_LE(above, boost::math::quantile(boost::math::complement(most, 1e-3)));
  // The mean violation is at most d/(S + 1); that it is not far below shows that the samples
  // matter.
  const double bound = 2.0 / static_cast<double>(samples + 1);
  EXPECT_LT(sum / kDraws, 1.1 * bound);
  EXPECT_GT(sum / kDraws, 0.2 * bound);
}

double sorted_cvar(std::vector<double> losses, double risk) {
  std::sort(losses.rbegin(), losses.rend());
  double left = risk * static_cast<double>(losses.size());
  double sum = 0.0;
  for (const double loss : losses) {
    const double share = std::min(1.0, left);
    sum += share * loss;
    left -= share;
    if (left <= 0.0) break;
  }
  return sum / (risk * static_cast<double>(losses.size()));
}

TEST(SmoothedCvar, tends_to_the_mean_of_the_worst_share) {
  const Eigen::VectorXd sample = models::standard_normal_sample(333, {.seed = 8});
  const std::vector<double> losses(sample.begin(), sample.end());
  Eigen::ArrayXd weights;
  for (const double risk : {0.01, 0.05, 0.3, 0.5}) {
    const double truth = sorted_cvar(losses, risk);
    EXPECT_NEAR(smoothed_cvar(sample.array(), risk, 1e-9, weights), truth, 1e-7);
    for (const double smoothing : {0.01, 0.1}) {
      const double smoothed = smoothed_cvar(sample.array(), risk, smoothing, weights);
      EXPECT_GE(smoothed, truth - 1e-12);
      EXPECT_LE(smoothed, truth + smoothing / (4.0 * risk) + 1e-12);
      EXPECT_NEAR(weights.sum(), 1.0, 1e-9);  // raising all losses by one raises the tail's mean by
                                              // one
      Eigen::ArrayXd other;
      for (const Eigen::Index i : {0, 17, 200}) {
        Eigen::ArrayXd up = sample.array();
        Eigen::ArrayXd down = sample.array();
        up[i] += 1e-6;
        down[i] -= 1e-6;
        const double slope = (smoothed_cvar(up, risk, smoothing, other) -
                              smoothed_cvar(down, risk, smoothing, other)) /
                             2e-6;
        EXPECT_NEAR(weights[i], slope, 1e-6);
      }
    }
  }
}

TEST(Drcc, tends_to_cvar_as_the_ball_shrinks_and_costs_more_with_it) {
  const auto system = cart();
  ChancePlannerSettings settings = wall_settings("cvar");
  settings.chance.paths = 200;
  ChancePlanner cvar(*system, settings);
  const double without = cvar.plan(cart_belief(), 0).cost.total();
  settings.constraint = "drcc";
  double last = without;
  for (const double radius : {1e-7, 0.002, 0.01}) {
    settings.chance.radius = radius;
    ChancePlanner robust(*system, settings);
    const ChancePlan& plan = robust.plan(cart_belief(), 0);
    EXPECT_EQ(plan.violation, 0.0);
    const double cost = plan.cost.total();
    if (radius < 1e-6) {
      EXPECT_NEAR(cost, without, 1e-3 * without);
    } else {
      EXPECT_GT(cost, last);
    }
    last = cost;
  }
}

TEST(DisturbanceFeedback, costs_no_more_than_state_feedback_with_given_gains) {
  const auto system = cart();
  ChancePlannerSettings settings = wall_settings("scenario");
  settings.problem.horizon = 5;
  settings.problem.max_evaluations = 2000;
  settings.chance.paths = 60;
  // Feedback from the initial state would need a memory of it; with exact knowledge only the noises
  // are left.
  const Gaussian start{.mean = cart_belief().mean, .covariance = Eigen::Matrix2d::Zero()};
  ChancePlannerSettings noise = settings;
  noise.chance.memory = 5;
  ChancePlanner by_noise(*system, noise);
  const ChancePlan& best = by_noise.plan(start, 0);
  EXPECT_LT(best.violation, 1e-3);
  const double least = best.cost.total();
  ChancePlanner open(*system, settings);
  EXPECT_LT(least, open.plan(start, 0).cost.total());
  settings.problem.closed_loop = true;
  for (const double stiffness : {0.2, 0.5, 1.0}) {
    settings.problem.feedback_gain = Eigen::RowVector2d(-stiffness, -2.0 * stiffness);
    ChancePlanner by_state(*system, settings);
    const ChancePlan& plan = by_state.plan(start, 0);
    EXPECT_LT(plan.violation, 1e-3);
    EXPECT_LT(least, 1.002 * plan.cost.total()) << "stiffness " << stiffness;
  }
}

}  // namespace chance_constraints_test
}  // namespace qsmpc::controller
