#include "controller/control/mppi/noise_paths.hpp"

#include "models/linear_algebra.hpp"
#include "models/random/random_numbers.hpp"

namespace qsmpc::controller {

const Eigen::MatrixXd& CovarianceRoot::of(const Eigen::MatrixXd& covariance) {
  if (root_.size() == 0 || covariance_ != covariance) {
    covariance_ = covariance;
    const models::SymmetricEigen eigen = models::symmetric_eigen(covariance);
    root_ = eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  }
  return root_;
}

NoisePaths::NoisePaths(int paths, int horizon, Eigen::Index state_dim)
    : paths_(static_cast<std::size_t>(paths), Eigen::MatrixXd::Zero(state_dim, horizon + 1)),
      normals_(state_dim, horizon + 1) {}

void NoisePaths::draw(const NoiseDraw& from) {
  std::uint64_t number = 0;
  for (Eigen::MatrixXd& path : paths_) {
    models::standard_normals({.seed = from.seed,
                              .episode = number++,
                              .stream = models::RandomStream::kSampledNoise,
                              .step = from.draw},
                             {normals_.data(), static_cast<std::size_t>(normals_.size())});
    path.col(0).noalias() = from.start_root * normals_.col(0);
    for (Eigen::Index k = 1; k < path.cols(); ++k) {
      path.col(k).noalias() = from.step_root * normals_.col(k);
    }
  }
}

void add_own_noise(const NoiseDraw& from, int horizon, int stage, int chunk, Points& states,
                   Points& normals) {
  const std::uint64_t stages = static_cast<std::uint64_t>(horizon) + 1;
  models::standard_normals({.seed = from.seed,
                            .episode = static_cast<std::uint64_t>(chunk),
                            .stream = models::RandomStream::kSampledNoise,
                            .step = from.draw * stages + static_cast<std::uint64_t>(stage)},
                           {normals.data(), static_cast<std::size_t>(normals.size())});
  const Eigen::MatrixXd& root = stage == 0 ? from.start_root : from.step_root;
  for (Eigen::Index i = 0; i < states.rows(); ++i) {
    for (Eigen::Index j = 0; j < states.rows(); ++j) {
      if (root(i, j) != 0.0) states.row(i) += root(i, j) * normals.row(j);
    }
  }
}

}  // namespace qsmpc::controller
