#include "controller/planning/planner_settings.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace qsmpc::controller {
namespace {

// Relative; allows for the rounding of a computed symmetric matrix.
constexpr double kSymmetryTolerance = 1e-12;

void require(bool holds, const std::string& message) {
  if (!holds) throw std::invalid_argument("planner: " + message);
}

void require_square(const Eigen::MatrixXd& matrix, Eigen::Index size, const std::string& name) {
  require(
      matrix.rows() == size && matrix.cols() == size && matrix.allFinite(),
      name + " must be a finite matrix of " + std::to_string(size) + " x " + std::to_string(size));
}

/// Needed because the gradient of xᵀWx is taken as 2Wx.
void require_symmetric(const Eigen::MatrixXd& matrix, const std::string& name) {
  require(matrix.isApprox(matrix.transpose(), kSymmetryTolerance), name + " must be symmetric");
}

}  // namespace

void check_planner_settings(const PlannerSettings& settings, int state_dim, int input_dim) {
  require(settings.horizon >= 1, "the horizon must be at least 1");
  require(settings.max_evaluations >= 1, "at least one evaluation of the cost is needed");
  require(settings.state_points >= 1, "at least one point is needed for the belief");
  require_square(settings.noise_covariance, state_dim, "the noise covariance");
  require_square(settings.cost.state, state_dim, "the state cost");
  require_square(settings.cost.terminal, state_dim, "the terminal cost");
  require_square(settings.cost.input, input_dim, "the input cost");
  require_symmetric(settings.cost.state, "the state cost");
  require_symmetric(settings.cost.terminal, "the terminal cost");
  require_symmetric(settings.cost.input, "the input cost");
  require(settings.cost.target.size() == state_dim && settings.cost.target.allFinite(),
          "the target must be a finite state");
  require(std::all_of(settings.cost.angles.begin(), settings.cost.angles.end(),
                      [&](int index) { return index >= 0 && index < state_dim; }),
          "the target's angles must be indices of states");
  require(!settings.path || settings.path->path != nullptr, "there must be a path to follow");
  require(!settings.path || !settings.guide, "a path and a guide cannot be combined");
  require(!settings.waypoints || (!settings.path && !settings.guide),
          "waypoints cannot be combined with a path or a guide");
  require(!settings.waypoints ||
              (settings.waypoints->states.rows() == state_dim && settings.waypoints->count() > 0 &&
               settings.waypoints->states.allFinite()),
          "waypoints must be finite states, at least one");
  require(settings.penalty.length > 0.0, "the penalty's length must be positive");
  require(settings.penalty.box >= 0.0 && settings.penalty.obstacle >= 0.0,
          "penalty weights must not be negative");
  require(settings.safe_set.dim() == state_dim, "the safe set must have the state's dimension");
  require(settings.bounds.lower.size() == input_dim && settings.bounds.upper.size() == input_dim &&
              settings.bounds.lower.allFinite() && settings.bounds.upper.allFinite() &&
              (settings.bounds.lower.array() < settings.bounds.upper.array()).all(),
          "the input bounds must be finite, lower < upper");
  if (settings.feedback_gain) {
    require(settings.feedback_gain->rows() == input_dim &&
                settings.feedback_gain->cols() == state_dim && settings.feedback_gain->allFinite(),
            "the feedback gain must be a finite matrix of inputs x states");
  }
  require(settings.risk.first >= 0.0 && settings.risk.stage >= 0.0 && settings.risk.plan >= 0.0,
          "risk limits must not be negative");
  require(settings.risk_reserve >= 0.0 && settings.risk_reserve < 1.0,
          "the reserve of risk limits must be at least 0 and below 1");
  const double effort = settings.feedback_effort.value_or(1.0);
  require(effort > 0.0 && std::isfinite(effort), "the feedback effort must be positive");
  require(settings.deadline > 0.0, "the deadline must be positive");
  require(settings.run != nullptr, "there must be an executor");
  check_safe_set(settings.safe_set);
}

std::vector<int> speeds_of(const models::Dynamics& dynamics) {
  std::vector<int> speeds;
  const std::vector<models::Coordinate>& states = dynamics.description().states;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].unit == "m/s") speeds.push_back(static_cast<int>(i));
  }
  return speeds;
}

}  // namespace qsmpc::controller
