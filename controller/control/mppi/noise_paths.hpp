// Noise for rollouts: realisations shared by all input sequences, or one per sequence.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"

namespace qsmpc::controller {

/// F with F Fᵀ = covariance; recomputed only when the covariance has changed.
class CovarianceRoot {
 public:
  /// covariance: n x n, symmetric positive semidefinite.
  const Eigen::MatrixXd& of(const Eigen::MatrixXd& covariance);

 private:
  Eigen::MatrixXd covariance_;
  Eigen::MatrixXd root_;
};

/// What noise is drawn from. The random numbers depend only on seed and draw.
struct NoiseDraw {
  const Eigen::MatrixXd& start_root;  ///< F of the belief
  const Eigen::MatrixXd& step_root;   ///< F of the process noise
  std::uint64_t seed = 0;
  std::uint64_t draw = 0;  ///< counts the draws of a drive
};

/// M realisations of the start and of the process noise.
class NoisePaths {
 public:
  NoisePaths(int paths, int horizon, Eigen::Index state_dim);

  void draw(const NoiseDraw& from);
  [[nodiscard]] Eigen::Index count() const { return std::ssize(paths_); }
  /// state_dim x (horizon + 1): column 0 is added to the mean of the belief, the others to the
  /// steps.
  [[nodiscard]] const Eigen::MatrixXd& path(Eigen::Index n) const {
    return paths_[static_cast<std::size_t>(n)];
  }

 private:
  std::vector<Eigen::MatrixXd> paths_;
  Eigen::MatrixXd normals_;
};

/// Adds an independent noise to each column of `states`: start noise at stage 0, process noise at
/// stages 1 … horizon. chunk: index of the chunk of samples. normals: scratch of the size of
/// `states`.
void add_own_noise(const NoiseDraw& from, int horizon, int stage, int chunk, Points& states,
                   Points& normals);

}  // namespace qsmpc::controller
