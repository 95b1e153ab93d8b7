// Moments of simulated paths at every stage, and the states of the first of them.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/prediction/policy.hpp"

namespace qsmpc::harness {

/// What many paths say of the laws of their states.
struct PathLaws {
  std::int64_t samples = 0;
  std::vector<controller::Gaussian> moments;  ///< mean and covariance at stages 1 … horizon
  /// The states of the first paths there, state_dim x kept.
  std::vector<controller::Points> paths;
};

/// Takes batches of paths from several threads, in any order; what it says of them does not depend
/// on it, to the last bit.
class PathCollector {
 public:
  /// Of one stage, about the policy's nominal state: what is added up keeps its digits.
  struct StageSums {
    Eigen::VectorXd offsets;  ///< Σ (x − x̄)
    Eigen::MatrixXd squares;  ///< Σ (x − x̄)(x − x̄)ᵀ
  };

  /// Keeps the first `kept` paths. `policy` must outlive it.
  PathCollector(const controller::Policy& policy, std::int64_t kept);

  /// The sums of `states` (state_dim x n) at stage `stage` ≥ 1, which are the paths from number
  /// `first` on; keeps those that are to be kept. Threads may call it at the same time for
  /// different paths.
  [[nodiscard]] StageSums collect(Eigen::Index stage, std::int64_t first,
                                  const controller::Points& states);

  /// Takes the sums of batch number `batch`, at all stages. Every number from 0 on has to come.
  void add(std::int64_t batch, std::vector<StageSums> sums);

  /// What there is of `samples` paths, all of which have been added.
  [[nodiscard]] PathLaws laws(std::int64_t samples);

 private:
  const controller::Policy& policy_;
  PathLaws laws_;
  std::vector<StageSums> total_;
  std::mutex mutex_;
  std::int64_t next_ = 0;  // batch that is to be added to the total
  std::map<std::int64_t, std::vector<StageSums>> waiting_;
};

}  // namespace qsmpc::harness
