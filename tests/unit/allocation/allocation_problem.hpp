// Problems on which planners and controllers are run in before their allocations are counted.
#pragma once

#include <string>

#include "controller/planning/planner_settings.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::testing {

/// A problem of moderate size; rarer settings not named here are off.
struct Case {
  std::string system;
  bool closed_loop = false;
  bool optimise_gain = false;
  std::string propagator = "mixture";
  bool obstacles = true;
  int points = 100;
};

inline std::string name_of(const Case& options) {
  return options.system + (options.closed_loop ? "_closed" : "_open") +
         (options.optimise_gain ? "_gain_" : "_") + options.propagator +
         (options.obstacles ? "_obstacles_" : "_free_") + std::to_string(options.points);
}

inline controller::PlannerSettings settings_of(const Case& options,
                                               const models::Dynamics& dynamics) {
  const Eigen::Index dim = dynamics.state_dim();
  const bool car = options.system == "dubins";
  controller::PlannerSettings settings;
  settings.horizon = 6;
  settings.closed_loop = options.closed_loop;
  settings.optimise_gain = options.optimise_gain;
  settings.propagator = options.propagator;
  settings.state_points = options.points;
  settings.noise_points = 50;
  settings.compressed_points = options.points;
  settings.noise_covariance = 1e-3 * Eigen::MatrixXd::Identity(dim, dim);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(dim);
  weights.head<2>().setConstant(4.0);
  settings.cost = {
      .state = weights.asDiagonal(),
      .input = 0.1 * Eigen::MatrixXd::Identity(dynamics.input_dim(), dynamics.input_dim()),
      .terminal = weights.asDiagonal(),
      .target = Eigen::VectorXd::Zero(dim),
      .angles = {dynamics.description().heading}};
  settings.cost.target.head<2>() << (car ? 5.0 : 40.0), 3.0;
  settings.safe_set = controller::unbounded_safe_set(dim);
  settings.safe_set.bounds.lower.head<2>().setConstant(-1.0);
  settings.safe_set.bounds.upper.head<2>().setConstant(50.0);
  if (options.obstacles) {
    controller::Box block{.lower = Eigen::VectorXd::Constant(dim, -1e9),
                          .upper = Eigen::VectorXd::Constant(dim, 1e9)};
    block.lower.head<2>() << (car ? 0.8 : 8.0), -0.5;
    block.upper.head<2>() << (car ? 1.2 : 10.0), 0.6;
    settings.safe_set.obstacles.push_back(block);
  }
  settings.bounds = {.lower = dynamics.description().input_lower,
                     .upper = dynamics.description().input_upper};
  return settings;
}

inline controller::Gaussian belief_of(const models::Dynamics& dynamics) {
  const Eigen::Index dim = dynamics.state_dim();
  controller::Gaussian belief{.mean = Eigen::VectorXd::Zero(dim),
                              .covariance = 0.005 * Eigen::MatrixXd::Identity(dim, dim)};
  const int speed = dynamics.description().state_index("longitudinal_speed");
  if (speed >= 0) belief.mean[speed] = 10.0;
  return belief;
}

}  // namespace qsmpc::testing
