// The truth that bounds are held against: simulated paths of the model under a plan's policy.
#pragma once

#include <random>
#include <vector>

#include "controller/measure/measures.hpp"
#include "controller/planning/safe_set.hpp"
#include "controller/prediction/prediction.hpp"

namespace qsmpc::testing {

using Generator = std::mt19937_64;

/// How many paths are unsafe, stage by stage (1 … horizon), and at any stage.
struct UnsafeCounts {
  std::vector<int> stages;
  int any = 0;
};

/// Simulates `paths` paths of x⁺ = f(x, u(x)) + w from the motion's belief under its policy.
/// states: where given, receives the states of every stage 1 … horizon (state_dim x paths each).
[[nodiscard]] UnsafeCounts simulate(const PredictedMotion& motion, const SafeSet& safe_set,
                                    int paths, Generator& generator,
                                    std::vector<Points>* states = nullptr);

}  // namespace qsmpc::testing
