// Settings of a planner.
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
  /// Closed loop with gains from LQR: factor on the input weight there relative to the cost, > 0.
  /// Gentler gains saturate the inputs less often, for which certificates assume the worst.
  /// Default: 1 or, with risk limits, the value that minimises the certificates.
  std::optional<double> feedback_effort;
  /// Closed loop: whether to optimise, along with the inputs, a matrix added to the gains of all
  /// stages.
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
  /// Of one plan, s, > 0. A plan makes at least one prediction, however long that takes.
  double deadline = std::numeric_limits<double>::infinity();
  Eigen::MatrixXd noise_covariance;  ///< state_dim x state_dim
  QuadraticCost cost;
  /// Path of a moving target, which replaces cost.target in the cost; the drive still ends at
  /// cost.target.
  std::optional<PathTarget> path{};
  /// Alternatively, waypoints to pass in order; the last one is then cost.target.
  std::optional<Waypoints> waypoints{};
  /// If the solver takes constraints, it keeps every particle within the bounds, and `box` is not
  /// used.
  Penalty penalty;
  SafeSet safe_set;
  RiskLimits risk;  ///< of every plan's certificates
  /// Share of `risk.stage` and `risk.plan` that plans leave to later ones where they can, 0 … 1
  /// (1 excluded).
  double risk_reserve = 0.0;
  RiskOtherwise otherwise = RiskOtherwise::kLeastRisk;
  /// Error of the model with respect to the plant; certificates then hold for the plant.
  std::optional<ModelError> model_error;
  InputBounds bounds;
  /// Whether plans aim along the cheapest way round obstacles (guide/guide.hpp) instead of straight
  /// at the target.
  bool guide = false;
  Executor run = run_in_turn;  ///< executor of loops over many particles
};

/// Throws std::invalid_argument on invalid settings for a system of these dimensions: wrong sizes,
/// non-finite entries, a horizon below 1. Names are checked where they are looked up.
void check_planner_settings(const PlannerSettings& settings, int state_dim, int input_dim);

/// Indices of the states that are speeds, in m/s, which braking drives to 0.
[[nodiscard]] std::vector<int> speeds_of(const models::Dynamics& dynamics);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
