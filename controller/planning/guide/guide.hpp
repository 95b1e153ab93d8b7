// Where a plan should head when the straight line to the target is blocked.
//
// A plan sees only as far as its horizon, and a cost that pulls straight towards the target leads
// it into every dead end. The guide finds a way round: the cheapest path in the plane, where the
// price of a metre grows with the probability that the vehicle would be unsafe there. Plans aim at
// the farthest point of that path that a straight line reaches at about the same cost, and at the
// target itself once it is such a point. This is a heuristic: certificates do not depend on it.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/planning/guide/travel_field.hpp"
#include "controller/planning/planner_settings.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

/// What a plan aims at.
struct Aim {
  Eigen::VectorXd state;  ///< state_dim; the target, or an intermediate aim in its place
  double way = 0.0;       ///< m, from the position to the target along the cheapest way
};

/// Standard deviation (m) of the position across the direction of travel, under feedback, at the
/// end of a horizon that starts at the target without uncertainty. The system must have a position.
[[nodiscard]] double lateral_deviation(const models::Dynamics& dynamics,
                                       const PlannerSettings& settings);

class Guide {
 public:
  /// Throws std::invalid_argument unless the system has a position in the plane with finite bounds
  /// in the safe set.
  Guide(const models::Dynamics& dynamics, const PlannerSettings& settings);

  /// The aim from `state` (state_dim, finite). Its heading, if there is one, points along the way,
  /// modulo 2π nearest to the state's; other coordinates are those of the target. Valid until the
  /// next call.
  const Aim& aim(const Eigen::Ref<const Eigen::VectorXd>& state);

  [[nodiscard]] const TravelField& field() const { return field_; }

 private:
  int x_;
  int y_;
  int heading_;
  Eigen::VectorXd target_;
  TravelField field_;
  std::vector<Eigen::Vector2d> way_;
  Aim aim_;
};

}  // namespace qsmpc::controller
