#include "tests/support/planning_quality.hpp"

#include <limits>

namespace qsmpc::testing {
namespace {

constexpr double kSpeed = 1.5;     // m/s
constexpr double kTimeStep = 0.1;  // s

Eigen::Matrix3d noise_covariance() { return Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal(); }

controller::Box block(double x_lower, double x_upper, double y_lower, double y_upper) {
  controller::Box result = controller::unbounded_safe_set(3).bounds;
  result.lower.head<2>() << x_lower, y_lower;
  result.upper.head<2>() << x_upper, y_upper;
  return result;
}

}  // namespace

controller::PlannerSettings free_settings(int horizon, bool closed_loop) {
  controller::PlannerSettings settings;
  settings.horizon = horizon;
  settings.closed_loop = closed_loop;
  settings.noise_covariance = noise_covariance();
  settings.cost = {.state = Eigen::Vector3d(60.0, 60.0, 1.0).asDiagonal(),
                   .input = Eigen::MatrixXd::Constant(1, 1, 2.0),
                   .terminal = Eigen::Vector3d(60.0, 60.0, 5.0).asDiagonal(),
                   .target = Eigen::Vector3d(11.0, 9.0, 0.0)};
  settings.safe_set = controller::unbounded_safe_set(3);
  settings.bounds = {.lower = Eigen::VectorXd::Constant(1, -2.0),
                     .upper = Eigen::VectorXd::Constant(1, 2.0)};
  return settings;
}

controller::PlannerSettings blocks_settings(int horizon) {
  controller::PlannerSettings settings = free_settings(horizon, /*closed_loop=*/true);
  settings.safe_set.bounds = block(-1.0, 12.0, -1.0, 12.0);
  settings.safe_set.obstacles = {block(2.0, 4.0, 2.0, 4.0), block(6.0, 8.0, 5.0, 8.0)};
  settings.penalty = {.box = 20000.0, .obstacle = 20000.0, .length = 0.6};
  return settings;
}

DubinsProblem closed_form_of(const controller::PlannerSettings& settings,
                             const controller::Gaussian& belief) {
  return {.speed = kSpeed,
          .time_step = kTimeStep,
          .belief = belief,
          .noise_covariance = settings.noise_covariance,
          .cost = settings.cost,
          .bounds = settings.bounds};
}

std::unique_ptr<const models::Dynamics> default_car() {
  return models::make_dynamics("dubins", {{"speed", kSpeed}}, kTimeStep);
}

controller::Gaussian first_belief(double x, double y, double heading) {
  return {.mean = Eigen::Vector3d(x, y, heading), .covariance = 0.01 * Eigen::Matrix3d::Identity()};
}

controller::Gaussian later_belief(double x, double y, double heading) {
  return {.mean = Eigen::Vector3d(x, y, heading), .covariance = noise_covariance()};
}

std::vector<Place> places_among_blocks() {
  return {{"start", first_belief(0.0, 0.0, 0.0)},
          {"below the first block", later_belief(1.8, 1.0, 0.3)},
          {"towards the first block's corner", later_belief(1.2, 1.4, 0.7)},
          {"past the first block", later_belief(4.6, 2.6, 0.8)},
          {"before the second block", later_belief(5.2, 4.6, 0.4)},
          {"near the target", later_belief(9.0, 7.6, 0.8)}};
}

Shortfall exact_shortfall(const controller::PlannerSettings& settings,
                          const controller::Gaussian& belief) {
  const std::unique_ptr<const models::Dynamics> car = default_car();
  const DubinsProblem problem = closed_form_of(settings, belief);
  const DubinsOptimum optimum = dubins_optimum(problem, settings.horizon);
  Shortfall result;
  controller::Planner planner(*car, settings);
  result.plan = planner.plan(belief);
  result.planned = dubins_cost(problem, result.plan.policy.inputs).total();
  result.predicted = result.plan.cost.total();
  result.best = optimum.cost;
  result.best_inputs = optimum.inputs;
  result.predicted_best = planner.prescribe(belief, optimum.inputs).cost.total();
  return result;
}

Shortfall sampled_shortfall(const models::Dynamics& dynamics,
                            const controller::PlannerSettings& settings,
                            const controller::Gaussian& belief, const SamplingSettings& sampling) {
  Shortfall result;
  controller::Planner planner(dynamics, settings);
  result.plan = planner.plan(belief);
  result.predicted = result.plan.cost.total();
  SampledProblem fresh(dynamics, settings, belief, sampling.price);
  result.planned = fresh.evaluate(result.plan.policy);
  result.best = std::numeric_limits<double>::infinity();
  for (const Eigen::MatrixXd& inputs :
       deepest_inputs(dynamics, settings, belief, sampling.search, {result.plan.policy.inputs})) {
    const double price = fresh.evaluate(inputs);
    if (price < result.best) {
      result.best = price;
      result.best_inputs = inputs;
    }
  }
  result.predicted_best = planner.prescribe(belief, result.best_inputs).cost.total();
  return result;
}

}  // namespace qsmpc::testing
