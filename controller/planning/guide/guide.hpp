// Where a plan should head for when the straight way to the target is not the way.
//
// A plan sees as far as its horizon goes, and a cost that pulls straight to the target leads it
// into every dead end on the way. The guide knows a way round: the cheapest one in the plane, where
// a metre costs the more, the likelier the vehicle would be unsafe there. Plans aim at the farthest
// point of it to which the straight line is about as cheap, and at the target itself once that is
// such a point. It is a heuristic: what a plan is certified for does not depend on it.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/planning/guide/travel_field.hpp"
#include "controller/planning/planner_settings.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

/// What a plan aims at.
struct Aim {
  Eigen::VectorXd state;  ///< state_dim; the target, or what stands for it
  double way = 0.0;       ///< m, from the position to the target along the cheapest way
};

/// Standard deviation (m) across the direction of travel that feedback leaves of the position at
/// the end of a horizon which begins at the target without uncertainty. The system must have a
/// position.
[[nodiscard]] double lateral_deviation(const models::Dynamics& dynamics,
                                       const PlannerSettings& settings);

class Guide {
 public:
  /// Throws std::invalid_argument unless the system has a position in the plane, whose bounds in
  /// the safe set are finite.
  Guide(const models::Dynamics& dynamics, const PlannerSettings& settings);

  /// From where `state` (state_dim, finite) is. The heading, if there is one, is along the way, and
  /// the one of its values modulo 2π that is nearest to the state's; other coordinates are those of
  /// the target. Valid until the next call.
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
