// How close the planner's policies come to the optimum: figures for tests and benchmarks.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "controller/planning/planner.hpp"
#include "tests/support/dubins_closed_form.hpp"
#include "tests/support/policy_search.hpp"

namespace qsmpc::testing {

/// The Dubins car of the default scenario, 100 points at every stage, no obstacles.
[[nodiscard]] controller::PlannerSettings free_settings(int horizon, bool closed_loop);

/// The same with the walls, obstacles and penalties of dubins_obstacles, closed loop.
[[nodiscard]] controller::PlannerSettings blocks_settings(int horizon);

/// The closed form's problem for these settings, which must have no walls and no obstacles.
[[nodiscard]] DubinsProblem closed_form_of(const controller::PlannerSettings& settings,
                                           const controller::Gaussian& belief);

/// The car's model.
[[nodiscard]] std::unique_ptr<const models::Dynamics> default_car();

/// Belief at (x, y, φ) as at the start of an episode, N(·, 0.01 I).
[[nodiscard]] controller::Gaussian first_belief(double x, double y, double heading);

/// Belief at (x, y, φ) as during an episode: the covariance of one step's noise.
[[nodiscard]] controller::Gaussian later_belief(double x, double y, double heading);

struct Place {
  std::string name;
  controller::Gaussian belief;
};

/// The start of dubins_obstacles and places along its episodes, some close to the obstacles.
[[nodiscard]] std::vector<Place> places_among_blocks();

/// Cost of a plan, and cost of the best policy found.
struct Shortfall {
  double planned = 0.0;
  double best = 0.0;
  double predicted = 0.0;  ///< the planner's own cost estimate of its plan
  /// The planner's cost estimate of the best policy: above `predicted` where the prediction
  /// misleads, below it where the solver stops too early or in another local minimum.
  double predicted_best = 0.0;
  Eigen::MatrixXd best_inputs;
  controller::Plan plan;
  [[nodiscard]] double absolute() const { return planned - best; }
  [[nodiscard]] double relative() const { return absolute() / best; }
};

/// By the closed form; open loop, no walls, no obstacles. For a first plan (no warm start).
[[nodiscard]] Shortfall exact_shortfall(const controller::PlannerSettings& settings,
                                        const controller::Gaussian& belief);

struct SamplingSettings {
  SearchSettings search{.draws = {.paths = 2000, .seed = 1}};
  Draws price{.paths = 20000, .seed = 2};
};

/// By simulated paths: the search and the evaluation use different draws. For a first plan (no warm
/// start).
[[nodiscard]] Shortfall sampled_shortfall(const models::Dynamics& dynamics,
                                          const controller::PlannerSettings& settings,
                                          const controller::Gaussian& belief,
                                          const SamplingSettings& sampling);

}  // namespace qsmpc::testing
