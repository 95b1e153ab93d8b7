// Random planning problems whose walls and obstacles stand near the path, and their truth by
// simulation.
#pragma once

#include <memory>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "controller/planning/planner.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::testing {

using Generator = std::mt19937_64;

struct Problem {
  std::unique_ptr<const Dynamics> dynamics;
  PlannerSettings settings;
  Gaussian belief;
};

/// A Dubins car with a non-diagonal belief and noise, 1 to 8 stages, 10 to 200 points, open loop,
/// LQR or a random gain, bounds a short way off the path, and 0 to 5 obstacles beside it.
[[nodiscard]] Problem random_problem(Generator& generator);

/// How many of `paths` simulated paths are unsafe, stage by stage (1 … horizon), and at any stage.
struct UnsafeCounts {
  std::vector<int> stages;
  int any = 0;
};
[[nodiscard]] UnsafeCounts simulate(const Problem& problem, const Policy& policy, int paths,
                                    Generator& generator);

}  // namespace qsmpc::testing
