// What a planner is made from.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "controller/parallel.hpp"
#include "controller/planning/cost/penalty.hpp"
#include "controller/planning/cost/quadratic_cost.hpp"
#include "controller/planning/risk/risk_limits.hpp"
#include "controller/prediction/model_error.hpp"
#include "controller/prediction/policy.hpp"
#include "controller/reference/path_target.hpp"
#include "controller/reference/waypoints.hpp"
#include "controller/regions/safe_set.hpp"
#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

struct PlannerSettings {
  int horizon = 8;
  bool closed_loop = true;
  std::optional<Eigen::MatrixXd> feedback_gain;  ///< input_dim x state_dim; else from LQR
  /// Closed loop with gains from LQR: how much more the input weighs there than in the cost, > 0.
  /// Gentler gains meet the bounds of the input less often, of which certificates make the worst.
  /// Unless given, 1, and with limits of the risk what the certificates are least for.
  std::optional<double> feedback_effort;
  /// Closed loop: whether a matrix that is added to the gains of all stages is optimised along with
  /// the inputs.
  bool optimise_gain = false;
  std::string solver = "lbfgs";
  std::string input_bounding =
      "bounded";  ///< a name of `input_boundings`, for solvers that let it be chosen
  std::string propagator = "mixture";
  QuantiserKind quantiser = QuantiserKind::kProduct;  ///< of the belief
  int state_points = 100;
  int noise_points = 100;
  int compressed_points = 100;
  int max_evaluations = 100;  ///< of the cost, in one plan
  /// Of one plan, s, > 0. A plan takes at least one prediction, however long that is.
  double deadline = std::numeric_limits<double>::infinity();
  Eigen::MatrixXd noise_covariance;  ///< state_dim x state_dim
  QuadraticCost cost;
  /// What the target of the cost moves along, in place of cost.target: then what the drive is to.
  std::optional<PathTarget> path{};
  /// Or what is driven to before it, in order; the last is then cost.target.
  std::optional<Waypoints> waypoints{};
  /// Where the solver takes constraints, it keeps every particle within the bounds, and `box` is
  /// not used.
  Penalty penalty;
  SafeSet safe_set;
  RiskLimits risk;  ///< of every plan's certificates
  RiskOtherwise otherwise = RiskOtherwise::kLeastRisk;
  /// How far the plant is from the model; what is certified then holds for the plant.
  std::optional<ModelError> model_error;
  InputBounds bounds;
  /// Whether plans aim along the cheapest way round obstacles (guide/guide.hpp), and not straight
  /// at the target.
  bool guide = false;
  Executor run = run_in_turn;  ///< what loops over many particles go through
};

/// Throws std::invalid_argument on settings that make no sense for a system of these dimensions:
/// sizes, non-finite entries, a horizon below 1. Names are checked by those who know them.
void check_planner_settings(const PlannerSettings& settings, int state_dim, int input_dim);

/// Indices of the states that are speeds, in m/s: what braking makes 0.
[[nodiscard]] std::vector<int> speeds_of(const models::Dynamics& dynamics);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
