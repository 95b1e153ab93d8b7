// The truth that bounds are held against: simulated paths of the model under a plan's policy.
#pragma once

#include <functional>
#include <random>
#include <vector>

#include "controller/measure/measures.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/regions/safe_set.hpp"

namespace qsmpc::testing {

using Generator = std::mt19937_64;

/// How many paths are unsafe, stage by stage (1 … horizon), and at any stage.
struct UnsafeCounts {
  std::vector<int> stages;
  int any = 0;
};

/// What a plant's error may depend on when it comes in at a stage; dim x paths each.
struct PlantMoment {
  Eigen::Index stage = 0;  ///< −1: into the belief, for motions with a belief error
  const controller::Points&
      stepped;  ///< where the model would be without noise; at −1 the belief's draws
  const controller::Points&
      last_noise;  ///< that came into the state now; zero before there was any
};

/// What a plant adds to the model at a moment, dim x paths; may keep a memory of earlier ones.
using PlantError = std::function<controller::Points(const PlantMoment&)>;

/// The period with which obstacles that move do so in `simulate`, s.
inline constexpr double kObstaclePeriod = 0.1;

/// Simulates `paths` paths of x⁺ = f(x, u(x)) + w from the motion's belief under its policy.
/// Obstacles that move begin to when the motion does, each path with its own of them.
/// states: where given, receives the states of every stage 1 … horizon (state_dim x paths each).
/// error: where given, the plant is x⁺ = f(x, u(x)) + e + w.
[[nodiscard]] UnsafeCounts simulate(const controller::PredictedMotion& motion,
                                    const controller::SafeSet& safe_set, int paths,
                                    Generator& generator,
                                    std::vector<controller::Points>* states = nullptr,
                                    const PlantError& error = {});

}  // namespace qsmpc::testing
