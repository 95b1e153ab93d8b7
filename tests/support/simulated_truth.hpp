// The reference for bounds: simulated paths of the model under a plan's policy.
#pragma once

#include <functional>
#include <random>
#include <vector>

#include "controller/measure/measures.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/regions/safe_set.hpp"

namespace qsmpc::testing {

using Generator = std::mt19937_64;

/// Numbers of unsafe paths at each stage (1 … horizon), and at any stage.
struct UnsafeCounts {
  std::vector<int> stages;
  int any = 0;
};

/// What a plant's error may depend on when it enters at a stage; dim x paths each.
struct PlantMoment {
  Eigen::Index stage = 0;  ///< −1: enters the belief, for motions with a belief error
  const controller::Points&
      stepped;  ///< noise-free successor state of the model; at −1 the draws of the belief
  const controller::Points&
      last_noise;  ///< noise that entered the current state; zero before the first
};

/// The plant's deviation from the model at a moment, dim x paths; may depend on earlier moments.
using PlantError = std::function<controller::Points(const PlantMoment&)>;

/// Period of the obstacles' motion in `simulate`, s.
inline constexpr double kObstaclePeriod = 0.1;

/// Simulates `paths` paths of x⁺ = f(x, u(x)) + w from the motion's belief under its policy. Moving
/// obstacles start with the motion, and each path has its own realisation of them.
/// states: if given, receives the states of every stage 1 … horizon (state_dim x paths each).
/// error: if given, the plant is x⁺ = f(x, u(x)) + e + w.
[[nodiscard]] UnsafeCounts simulate(const controller::PredictedMotion& motion,
                                    const controller::SafeSet& safe_set, int paths,
                                    Generator& generator,
                                    std::vector<controller::Points>* states = nullptr,
                                    const PlantError& error = {});

}  // namespace qsmpc::testing
