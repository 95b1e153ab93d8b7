// What chance constraints are made from.
#pragma once

#pragma GCC visibility push(default)

namespace qsmpc::controller {

struct ChanceSettings {
  /// Probability with which a stage of a plan may be unsafe; with "scenario" any stage of it.
  double risk = 0.02;
  /// Paths that are sampled for a plan; 0: with "scenario" as many as the sample bound asks for, in
  /// the others kUsualPaths.
  int paths = 0;
  /// Of "scenario": probability with which the sampled paths are enough.
  double confidence = 0.9;
  /// Of "drcc": radius of the ball of laws about the sampled one, in the 1-Wasserstein distance, m.
  double radius = 0.002;
  /// Of "cvar" and "drcc": over how much of the clearance the tail's beginning is smoothed, m.
  double smoothing = 0.005;
  /// Noises before a stage that its input may answer to, by matrices that are optimised:
  /// disturbance feedback; 0: none. Only of constraints on samples.
  int memory = 0;
};

inline constexpr int kUsualPaths = 200;

/// Throws std::invalid_argument on settings that make no sense.
void check_chance_settings(const ChanceSettings& settings);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
