// Random vectors that depend on nothing but their key: whatever the order of calls or the number of
// threads, a key gives the same numbers. Counter-based generator: Philox4x64-10 (Salmon, Moraes,
// Dror, Shaw: "Parallel random numbers: as easy as 1, 2, 3", SC 2011).
//
//   const GaussianSampler noise(Eigen::VectorXd::Zero(3), covariance);
//   const Eigen::VectorXd w = noise.sample({.seed = 1, .episode = 7,
//                                           .stream = RandomStream::kDisturbance, .step = k});
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

namespace qsmpc::models {

/// What random numbers are for. Values are part of what a seed means: never renumber.
enum class RandomStream : std::uint64_t {
  kInitialState = 0,
  kDisturbance = 1,
  kInput = 2,       ///< random inputs, as for measuring the mismatch between plant and model
  kPrediction = 3,  ///< paths of the model, one an episode; step 0 is the initial state
  kSensor = 4,      ///< what the planner sees less what is
  kParameters = 5,  ///< parameters of a plant that are drawn
  kBootstrap = 6,   ///< weights of an episode in the replicates of a sample of episodes
  kPlanning = 7,    ///< paths that a controller samples, a period an episode
  kSearch = 8,      ///< the order in which the points of a grid of settings are tried
  kSplitting = 9,   ///< parents and seeds of paths that are split, a generation an episode
  // Obstacles that move, each an episode.
  kObstacleWay = 10,     ///< which way one goes
  kObstacleStart = 11,   ///< where it is at the beginning, and how fast
  kObstacleMotion = 12,  ///< what pushes it off its way
  kObstacleSensor = 13,  ///< what is seen of its place less what is
  // Controllers that sample; their "episode" is a chunk of samples.
  kSampledInputs = 16,  ///< perturbations of inputs
  kSampledNoise = 17,   ///< process noise of their rollouts
};

struct RandomKey {
  std::uint64_t seed = 0;
  std::uint64_t episode = 0;
  RandomStream stream = RandomStream::kDisturbance;
  std::uint64_t step = 0;
};

/// `count` independent standard normal numbers.
[[nodiscard]] Eigen::VectorXd standard_normal_sample(Eigen::Index count, const RandomKey& key);

/// Fills `out` with the same numbers; allocates nothing.
void standard_normals(const RandomKey& key, std::span<double> out);

/// `count` independent numbers, uniform in (0, 1].
[[nodiscard]] Eigen::VectorXd uniform_sample(Eigen::Index count, const RandomKey& key);

/// Fills `out` with independent words of 64 random bits.
void random_words(const RandomKey& key, std::span<std::uint64_t> out);

/// N(mean, covariance), its covariance's root computed once.
class GaussianSampler {
 public:
  /// mean: n; covariance: n x n, symmetric positive semidefinite up to rounding.
  /// Throws std::invalid_argument on other sizes, numbers that are not finite, or a covariance that
  /// is not symmetric positive semidefinite.
  GaussianSampler(Eigen::VectorXd mean, const Eigen::MatrixXd& covariance);

  /// mean + Σ^½ z with the symmetric root and z = standard_normal_sample(n, key).
  [[nodiscard]] Eigen::VectorXd sample(const RandomKey& key) const;

 private:
  Eigen::VectorXd mean_;
  Eigen::MatrixXd root_;
};

}  // namespace qsmpc::models
