// How near the planner's policies come to the best ones: figures for tests and benchmarks.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "controller/planning/planner.hpp"
#include "tests/support/dubins_closed_form.hpp"
#include "tests/support/policy_search.hpp"

namespace qsmpc::testing {

/// The Dubins car of the default scenario, 100 points everywhere, nothing in its way.
[[nodiscard]] controller::PlannerSettings free_settings(int horizon, bool closed_loop);

/// The same with the walls, the blocks and the penalties of dubins_obstacles, closed loop.
[[nodiscard]] controller::PlannerSettings blocks_settings(int horizon);

/// The closed form's problem of these settings, which must be without walls and obstacles.
[[nodiscard]] DubinsProblem closed_form_of(const controller::PlannerSettings& settings,
                                           const controller::Gaussian& belief);

/// The car's model.
[[nodiscard]] std::unique_ptr<const models::Dynamics> default_car();

/// At (x, y, φ) as at the start of an episode, N(·, 0.01 I).
[[nodiscard]] controller::Gaussian first_belief(double x, double y, double heading);

/// At (x, y, φ) as in the course of an episode: with the covariance of one step's noise.
[[nodiscard]] controller::Gaussian later_belief(double x, double y, double heading);

struct Place {
  std::string name;
  controller::Gaussian belief;
};

/// The start of dubins_obstacles, places along its episodes, some near to the blocks.
[[nodiscard]] std::vector<Place> places_among_blocks();

/// What a plan costs, and what the best policy that was found costs.
struct Shortfall {
  double planned = 0.0;
  double best = 0.0;
  double predicted = 0.0;  ///< what the planner says that its plan costs
  /// What it says that the best policy costs: above `predicted` where the prediction misleads,
  /// below where the solver ends too early or in another valley.
  double predicted_best = 0.0;
  Eigen::MatrixXd best_inputs;
  controller::Plan plan;
  [[nodiscard]] double absolute() const { return planned - best; }
  [[nodiscard]] double relative() const { return absolute() / best; }
};

/// By the closed form; open loop, no walls, no obstacles. A first plan, without one before it.
[[nodiscard]] Shortfall exact_shortfall(const controller::PlannerSettings& settings,
                                        const controller::Gaussian& belief);

struct SamplingSettings {
  SearchSettings search{.draws = {.paths = 2000, .seed = 1}};
  Draws price{.paths = 20000, .seed = 2};
};

/// By simulated paths: the search sees other draws than the price. A first plan, without one
/// before it.
[[nodiscard]] Shortfall sampled_shortfall(const models::Dynamics& dynamics,
                                          const controller::PlannerSettings& settings,
                                          const controller::Gaussian& belief,
                                          const SamplingSettings& sampling);

}  // namespace qsmpc::testing
