// Many paths of a plant under one policy, next to those of the model with the same initial states
// and disturbances.
//
//   const PathSource source(policy, belief, noise_covariance, {.seed = 1});
//   const std::vector<Points> model = model_paths(*model, source, 1000, run);
//   const PlantPaths plant = plant_paths(pool, *model, source, 1000, run, work);
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/parallel.hpp"
#include "controller/prediction/policy.hpp"
#include "harness/mismatch/plant_pool.hpp"
#include "harness/threads/shared_work.hpp"
#include "models/dynamics/dynamics.hpp"
#include "models/random/random_numbers.hpp"

namespace qsmpc::harness {

/// A range of the paths that belong to a seed. Paths with different numbers are independent.
struct PathNumbers {
  std::uint64_t seed = 0;
  std::uint64_t first = 0;  ///< number of the first path
};

/// The source of paths: x_0 ~ belief, x_{k+1} = plant(x_k, u_k(x_k)) + w_k, w_k ~ N(0, Σ). Path i
/// depends only on the seed and its number, and equals the path of that number that
/// `qsmpc predict --monte-carlo` simulates.
class PathSource {
 public:
  /// `policy` must outlive it. Throws std::invalid_argument on an invalid covariance.
  PathSource(const controller::Policy& policy, const controller::Gaussian& belief,
             const Eigen::MatrixXd& noise_covariance, const PathNumbers& numbers);

  [[nodiscard]] const controller::Policy& policy() const { return policy_; }
  [[nodiscard]] Eigen::Index stages() const { return policy_.horizon(); }
  /// x_0 of path `path`, counted from the first (state_dim).
  [[nodiscard]] Eigen::VectorXd initial_state(std::int64_t path) const;
  /// w of that path for the period from `stage` (≥ 0) to the next (state_dim).
  [[nodiscard]] Eigen::VectorXd disturbance(std::int64_t path, Eigen::Index stage) const;

 private:
  [[nodiscard]] models::RandomKey key(std::int64_t path, Eigen::Index step) const;

  const controller::Policy& policy_;
  PathNumbers numbers_;
  models::GaussianSampler initial_;
  models::GaussianSampler noise_;
};

/// The states of `count` paths of the model at stages 0 … horizon, each state_dim x count.
[[nodiscard]] std::vector<controller::Points> model_paths(const models::Dynamics& model,
                                                          const PathSource& source,
                                                          std::int64_t count,
                                                          const controller::Executor& run);

/// Paths of a plant. After a failure of the plant, the rest of its path is not a number.
struct PlantPaths {
  std::vector<controller::Points> states;  ///< stages 0 … horizon, state_dim x count
  std::vector<controller::Points>
      residuals;            ///< x_{k+1} − w_k − f(x_k, u_k), horizon, state_dim x count
  std::int64_t faults = 0;  ///< paths whose plant failed, or whose drawn vehicle was rejected
};

/// Paths per unit of `SharedWork`.
inline constexpr std::int64_t kPathBatch = 20;

/// The number of work units of `plant_paths`.
[[nodiscard]] inline std::int64_t path_batches(std::int64_t count) {
  return (count + kPathBatch - 1) / kPathBatch;
}

/// Drives plants of `plants` along `count` paths; the policy is evaluated at the plant's own state.
/// The result does not depend on `run`. Incomplete if `work` was stopped.
[[nodiscard]] PlantPaths plant_paths(PlantPool& plants, const models::Dynamics& model,
                                     const PathSource& source, std::int64_t count,
                                     const controller::Executor& run, SharedWork& work);

/// Simulated seconds per second of one plant in this thread: the median over `count` ≥ 1 paths.
/// Depends on the machine and its load.
[[nodiscard]] double simulation_speed(Plant& plant, const PathSource& source, double time_step,
                                      int count);

}  // namespace qsmpc::harness
