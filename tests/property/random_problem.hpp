// Random planning problems whose walls and obstacles stand near the path.
#pragma once

#include <memory>
#include <string>

#include "controller/planning/planner.hpp"
#include "models/dynamics/dynamics.hpp"
#include "tests/support/simulated_truth.hpp"

namespace qsmpc::testing {

/// A draw from the interval.
[[nodiscard]] double uniform(Generator& generator, double lower, double upper);

struct Problem {
  std::string system;
  std::unique_ptr<const models::Dynamics> dynamics;
  controller::PlannerSettings settings;
  controller::Gaussian belief;
};

/// Any of the systems with correlated belief and noise (sometimes singular), 1 to 8 stages, 10 to
/// 200 points, any propagator, open loop, LQR or a random gain, bounds a short way off the path,
/// 0 to 5 obstacles beside it, a point or up to four discs for a body, and sometimes a limit of the
/// plan's risk.
[[nodiscard]] Problem random_problem(Generator& generator);

/// The same of a system of a user's: of tests/support/own_systems.hpp.
[[nodiscard]] Problem random_own_problem(Generator& generator);

}  // namespace qsmpc::testing
