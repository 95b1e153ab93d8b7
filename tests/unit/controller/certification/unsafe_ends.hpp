// Walls next to the ends of a case's paths.
#pragma once

#include <algorithm>
#include <vector>

#include "tests/support/simulated_truth.hpp"
#include "tests/unit/controller/certification/surrogate_cases.hpp"

namespace qsmpc::testing {

/// Makes the highest `share` of the paths in this coordinate unsafe at the last stage.
inline controller::SafeSet unsafe_at_the_end(const Case& one, Eigen::Index axis, double share) {
  constexpr int kDrawn = 20000;
  Generator generator(217);
  std::vector<controller::Points> states;
  controller::SafeSet safe_set = controller::unbounded_safe_set(one.dynamics->state_dim());
  (void)simulate(one.motion(), safe_set, kDrawn, generator, &states);
  Eigen::VectorXd last = states.back().row(axis);
  std::sort(last.begin(), last.end());
  safe_set.bounds.upper[axis] = last[static_cast<Eigen::Index>((1.0 - share) * kDrawn)];
  return safe_set;
}

}  // namespace qsmpc::testing
