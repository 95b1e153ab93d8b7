// Symmetric square roots of covariances, which may be singular.
#pragma once

#include <Eigen/Core>

#include "models/linear_algebra.hpp"

namespace qsmpc::controller {

/// The symmetric S with S² = `covariance` (d x d, finite, symmetric); negative eigenvalues, which
/// come from rounding, count as zero.
[[nodiscard]] inline Eigen::MatrixXd covariance_root(const Eigen::MatrixXd& covariance) {
  const models::SymmetricEigen eigen = models::symmetric_eigen(covariance);
  return eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         eigen.vectors.transpose();
}

/// ½ (M + Mᵀ).
[[nodiscard]] inline Eigen::MatrixXd symmetric_part(const Eigen::MatrixXd& matrix) {
  return 0.5 * (matrix + matrix.transpose());
}

}  // namespace qsmpc::controller
