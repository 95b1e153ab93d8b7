// Noise for rollouts: realisations that every input sequence is rolled out in, or one for each.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"

namespace qsmpc::controller {

/// F with F Fᵀ = a covariance; works one out only where it is another one than before.
class CovarianceRoot {
 public:
  /// covariance: n x n, symmetric positive semidefinite.
  const Eigen::MatrixXd& of(const Eigen::MatrixXd& covariance);

 private:
  Eigen::MatrixXd covariance_;
  Eigen::MatrixXd root_;
};

/// What noise is drawn from. Numbers depend on seed and draw alone.
struct NoiseDraw {
  const Eigen::MatrixXd& start_root;  ///< F of the belief
  const Eigen::MatrixXd& step_root;   ///< F of the process noise
  std::uint64_t seed = 0;
  std::uint64_t draw = 0;  ///< counts draws of the drive
};

/// M realisations of the start and of the process noise.
class NoisePaths {
 public:
  NoisePaths(int paths, int horizon, Eigen::Index state_dim);

  void draw(const NoiseDraw& from);
  [[nodiscard]] Eigen::Index count() const { return std::ssize(paths_); }
  /// state_dim x (horizon + 1): what is added to the mean of the belief, and to each step.
  [[nodiscard]] const Eigen::MatrixXd& path(Eigen::Index n) const {
    return paths_[static_cast<std::size_t>(n)];
  }

 private:
  std::vector<Eigen::MatrixXd> paths_;
  Eigen::MatrixXd normals_;
};

/// Adds to every column of `states` noise of its own: of the start at stage 0, of the step at
/// stages 1 … horizon. chunk: the number of the chunk of samples. normals: scratch of the same
/// size.
void add_own_noise(const NoiseDraw& from, int horizon, int stage, int chunk, Points& states,
                   Points& normals);

}  // namespace qsmpc::controller
