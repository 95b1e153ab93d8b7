// Random planning problems with walls and obstacles close to the path.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "controller/planning/planner.hpp"
#include "models/dynamics/dynamics.hpp"
#include "tests/support/simulated_truth.hpp"

namespace qsmpc::testing {

struct Problem {
  std::string system;
  std::unique_ptr<const models::Dynamics> dynamics;
  controller::PlannerSettings settings;
  controller::Gaussian belief;
};

/// Any of the systems with correlated belief and noise (sometimes singular), 1 to 8 stages, 10 to
/// 200 points, any propagator, open loop, LQR or a random gain, bounds a short distance off the
/// path, 0 to 5 obstacles beside it, a body of a point or up to four discs, and sometimes a limit
/// on the plan's risk.
[[nodiscard]] Problem random_problem(Generator& generator);

/// The kinds of planar shapes: "disc", "ellipse", "box", "polygon" (convex), "corner" (a non-convex
/// polygon), "half_plane", and "road": the outside of a winding road.
[[nodiscard]] const std::vector<std::string>& shape_kinds();

/// As random_problem, for a planar system, with 1 to 4 shapes of this kind beside the path instead
/// of boxes, and no walls.
[[nodiscard]] Problem random_shape_problem(Generator& generator, const std::string& kind);

/// As random_shape_problem, with shapes that move along one or more ways, sometimes turning with
/// them, and the forecast made without any observation of them.
[[nodiscard]] Problem random_moving_problem(Generator& generator, const std::string& kind);

/// The same for a user-defined system of tests/support/own_systems.hpp.
[[nodiscard]] Problem random_own_problem(Generator& generator);

}  // namespace qsmpc::testing
