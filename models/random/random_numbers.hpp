// Random vectors that depend only on their key: a key gives the same numbers for any order of calls
// and any number of threads. Counter-based generator: Philox4x64-10 (Salmon, Moraes, Dror, Shaw:
// "Parallel random numbers: as easy as 1, 2, 3", SC 2011).
//
//   const GaussianSampler noise(Eigen::VectorXd::Zero(3), covariance);
//   const Eigen::VectorXd w = noise.sample({.seed = 1, .episode = 7,
//                                           .stream = RandomStream::kDisturbance, .step = k});
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

namespace qsmpc::models {

/// The purpose of random numbers. The values are part of the meaning of a seed: never renumber.
enum class RandomStream : std::uint64_t {
  kInitialState = 0,
  kDisturbance = 1,
  kInput = 2,       ///< random inputs, as for measuring the mismatch between plant and model
  kPrediction = 3,  ///< paths of the model, one per episode; step 0 is the initial state
  kSensor = 4,      ///< what the planner measures minus the true state
  kParameters = 5,  ///< random parameters of a plant
  kBootstrap = 6,   ///< weights of an episode in the bootstrap replicates of a sample of episodes
  kPlanning = 7,    ///< paths that a controller samples, one period per episode
  kSearch = 8,      ///< the order in which a grid of settings is searched
  kSplitting = 9,   ///< parents and seeds of split paths, one generation per episode
  // Moving obstacles, one per episode.
  kObstacleWay = 10,     ///< which way an obstacle takes
  kObstacleStart = 11,   ///< its place and velocity at the start
  kObstacleMotion = 12,  ///< disturbances off its way
  kObstacleSensor = 13,  ///< its measured minus its true place
  // Sampling-based controllers; their "episode" is a chunk of samples.
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

/// Samples N(mean, covariance); the root of the covariance is computed once.
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
