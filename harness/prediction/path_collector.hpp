// Moments of simulated paths at every stage, and the states of the first paths.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/prediction/policy.hpp"

namespace qsmpc::harness {

/// Empirical laws of the states of many paths.
struct PathLaws {
  std::int64_t samples = 0;
  std::vector<controller::Gaussian> moments;  ///< mean and covariance at stages 1 … horizon
  /// The states of the first paths at these stages, state_dim x kept.
  std::vector<controller::Points> paths;
};

/// Takes batches of paths from several threads, in any order; the result does not depend on the
/// order, to the last bit.
class PathCollector {
 public:
  /// Sums at one stage, relative to the policy's nominal state to avoid cancellation.
  struct StageSums {
    Eigen::VectorXd offsets;  ///< Σ (x − x̄)
    Eigen::MatrixXd squares;  ///< Σ (x − x̄)(x − x̄)ᵀ
  };

  /// Keeps the first `kept` paths. `policy` must outlive it.
  PathCollector(const controller::Policy& policy, std::int64_t kept);

  /// Returns the sums of `states` (state_dim x n) at stage `stage` ≥ 1 of the paths from number
  /// `first` on, and keeps those that are to be kept. Threads may call it concurrently for
  /// different paths.
  [[nodiscard]] StageSums collect(Eigen::Index stage, std::int64_t first,
                                  const controller::Points& states);

  /// Adds the sums of batch number `batch` at all stages. Every number from 0 on must be added.
  void add(std::int64_t batch, std::vector<StageSums> sums);

  /// The laws of `samples` paths, all of which have been added.
  [[nodiscard]] PathLaws laws(std::int64_t samples);

 private:
  const controller::Policy& policy_;
  PathLaws laws_;
  std::vector<StageSums> total_;
  std::mutex mutex_;
  std::int64_t next_ = 0;  // next batch to be added to the total
  std::map<std::int64_t, std::vector<StageSums>> waiting_;
};

}  // namespace qsmpc::harness
