// The planner against an exhaustive grid: where the grid has a plan that is certified with a
// margin, the planner returns a certified plan of about the same cost.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "controller/planning/planner.hpp"
#include "models/constants.hpp"
#include "tests/property/random_draws.hpp"
#include "tests/property/random_problem.hpp"
#include "tests/support/effort.hpp"

namespace qsmpc::controller {
namespace risk_planning_test {

using namespace testing;

constexpr int kShards = 4;
// The share of the limit that the grid's plan may use.
constexpr double kRoom = 0.95;

int problem_count() { return by_effort(60, 120, 500); }

struct LimitedProblem {
  std::unique_ptr<const models::Dynamics> dynamics;
  PlannerSettings settings;
  Gaussian belief;
};

/// A car with one input, one to four stages, blocks beside or across its way, and a limit.
LimitedProblem limited_problem(Generator& generator) {
  LimitedProblem problem;
  const char* const system = uniform(generator, 0.0, 1.0) < 0.5 ? "dubins" : "dubins_rk4";
  problem.dynamics = models::make_dynamics(system, {{"speed", uniform(generator, 1.0, 3.0)}}, 0.2);
  PlannerSettings& settings = problem.settings;
  settings.horizon = 1 + static_cast<int>(uniform(generator, 0.0, 3.999));
  settings.closed_loop = uniform(generator, 0.0, 1.0) < 0.5;
  settings.feedback_effort = 10.0;
  // From 48 points on, solvers see the coarse cost.
  settings.state_points = settings.horizon % 2 == 0 ? 60 : 30;
  settings.noise_points = 20;
  settings.compressed_points = settings.state_points;
  settings.max_evaluations = 300;
  settings.noise_covariance = Eigen::Vector3d(1e-3, 1e-3, 1e-4).asDiagonal();
  problem.belief = {.mean = Eigen::Vector3d(0.0, 0.0, uniform(generator, -0.5, 0.5)),
                    .covariance = Eigen::Vector3d(2e-3, 2e-3, 1e-3).asDiagonal()};
  settings.cost = {.state = Eigen::Vector3d(4.0, 4.0, 0.0).asDiagonal(),
                   .input = Eigen::MatrixXd::Constant(1, 1, 0.1),
                   .terminal = Eigen::Vector3d(4.0, 4.0, 0.0).asDiagonal(),
                   .target = Eigen::Vector3d(3.0, uniform(generator, -1.0, 1.0), 0.0)};
  settings.penalty.box = 0.0;
  settings.penalty.obstacle = 0.0;
  settings.bounds = {.lower = Eigen::VectorXd::Constant(1, -2.0),
                     .upper = Eigen::VectorXd::Constant(1, 2.0)};
  settings.safe_set = unbounded_safe_set(3);
  for (int n = 0; n < 2; ++n) {
    Box block = unbounded_safe_set(3).bounds;
    const double x = uniform(generator, 0.3, 1.8);
    const double y = uniform(generator, -0.8, 0.8);
    const double half = uniform(generator, 0.05, 0.3);
    block.lower.head<2>() << x - half, y - half;
    block.upper.head<2>() << x + half, y + half;
    settings.safe_set.obstacles.push_back(block);
  }
  if (uniform(generator, 0.0, 1.0) < 0.5) {
    settings.safe_set.body = {.discs = {{.radius = 0.05, .offset = {0.1, 0.0}}, {.radius = 0.05}},
                              .x = 0,
                              .y = 1,
                              .heading = 2};
  }
  settings.risk.plan = std::pow(10.0, uniform(generator, -3.0, -0.7));
  return problem;
}

/// The least cost of a certified plan on a grid of inputs; infinity without one.
double best_on_grid(Planner& planner, const Gaussian& belief) {
  const PlannerSettings& settings = planner.settings();
  const int side = std::vector<int>{201, 41, 13, 7}[settings.horizon - 1];
  double best = kInfinity;
  Eigen::MatrixXd inputs(1, settings.horizon);
  const int count = static_cast<int>(std::lround(std::pow(side, settings.horizon)));
  for (int n = 0; n < count; ++n) {
    for (int k = 0, rest = n; k < settings.horizon; ++k, rest /= side) {
      inputs(0, k) = -2.0 + 4.0 * (rest % side) / (side - 1.0);
    }
    const Plan& plan = planner.prescribe(belief, inputs);
    if (plan.risk.plan > kRoom * settings.risk.plan) continue;
    best = std::min(best, plan.cost.total());
  }
  return best;
}

class LimitedPlans : public ::testing::TestWithParam<int> {};

TEST_P(LimitedPlans, are_certified_and_cost_what_the_best_on_a_grid_does) {
  Generator generator(4001 + static_cast<std::uint64_t>(GetParam()));
  int solvable = 0;
  int missed = 0;
  int binding = 0;
  std::vector<double> excess;
  for (int index = GetParam(); index < problem_count(); index += kShards) {
    const LimitedProblem problem = limited_problem(generator);
    Planner planner(*problem.dynamics, problem.settings);
    const double best = best_on_grid(planner, problem.belief);
    if (std::isinf(best)) continue;
    ++solvable;
    planner.reset();
    const Plan& plan = planner.plan(problem.belief);
    if (!plan.risk.kept) {
      ++missed;
      continue;
    }
    EXPECT_LE(plan.risk.plan, problem.settings.risk.plan);
    if (plan.risk.plan > 0.5 * problem.settings.risk.plan) ++binding;
    excess.push_back(plan.cost.total() / best - 1.0);
  }
  std::sort(excess.begin(), excess.end());
  ASSERT_FALSE(excess.empty());
  const double median = excess[excess.size() / 2];
  const auto within = static_cast<double>(
      std::count_if(excess.begin(), excess.end(), [](double one) { return one <= 0.02; }));
  RecordProperty("solvable", solvable);
  RecordProperty("missed", missed);
  RecordProperty("binding", binding);
  RecordProperty("median", std::to_string(median));
  RecordProperty("worst", std::to_string(excess.back()));
  // Allows one missed problem per shard.
  EXPECT_LE(missed, std::max(1, solvable / 100));
  EXPECT_GT(binding, solvable / 10);
  EXPECT_LE(median, 0.003);
  EXPECT_GE(within, 0.97 * static_cast<double>(excess.size()) - 1.0);
}

INSTANTIATE_TEST_SUITE_P(shards, LimitedPlans, ::testing::Range(0, kShards));

}  // namespace risk_planning_test
}  // namespace qsmpc::controller
