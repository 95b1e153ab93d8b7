// Settings of chance constraints.
#pragma once

#pragma GCC visibility push(default)

namespace qsmpc::controller {

struct ChanceSettings {
  /// Probability with which each stage of a plan may be unsafe; with "scenario", any stage of it.
  double risk = 0.02;
  /// Paths sampled per plan; 0: with "scenario" as many as the sample bound requires, else
  /// kUsualPaths.
  int paths = 0;
  /// Of "scenario": confidence that the number of sampled paths is sufficient.
  double confidence = 0.9;
  /// Of "drcc": radius of the ball of laws about the sampled one, in the 1-Wasserstein distance, m.
  double radius = 0.002;
  /// Of "cvar" and "drcc": half-width over which the hinge of the tail is smoothed, m of clearance.
  double smoothing = 0.005;
  /// Disturbance feedback: the number of past noises that a stage's input responds to, through
  /// matrices that are optimised; 0: none. Only for constraints on samples.
  int memory = 0;
};

inline constexpr int kUsualPaths = 200;

/// Throws std::invalid_argument on invalid settings.
void check_chance_settings(const ChanceSettings& settings);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
