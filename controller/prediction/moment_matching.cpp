#include "controller/prediction/moment_matching.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace qsmpc {
namespace {

// Eigenvalues below this fraction of the largest are rounding.
constexpr double kNoVariance = 1e-12;

Eigen::MatrixXd symmetric(const Eigen::MatrixXd& matrix) {
  return 0.5 * (matrix + matrix.transpose());
}

}  // namespace

Eigen::MatrixXd spread_between(const Eigen::MatrixXd& from, const Eigen::MatrixXd& to) {
  const Eigen::Index dim = from.rows();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(from);
  const double least = kNoVariance * eigen.eigenvalues()[dim - 1];
  Eigen::Index null = 0;  // eigenvalues increase
  while (null < dim && eigen.eigenvalues()[null] <= least) ++null;
  const Eigen::Index rank = dim - null;
  if (rank == 0) return Eigen::MatrixXd::Identity(dim, dim);
  // In the coordinates of the support U, where U'·from·U is diagonal.
  const Eigen::MatrixXd support = eigen.eigenvectors().rightCols(rank);
  const Eigen::VectorXd deviation = eigen.eigenvalues().tail(rank).cwiseSqrt();
  const Eigen::MatrixXd scaled_target =
      deviation.asDiagonal() * (support.transpose() * to * support) * deviation.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> target(symmetric(scaled_target));
  const Eigen::MatrixXd root = target.eigenvectors() *
                               target.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
                               target.eigenvectors().transpose();
  const Eigen::VectorXd inverse = deviation.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> stretch(
      symmetric(inverse.asDiagonal() * root * inverse.asDiagonal()));
  const Eigen::MatrixXd axes = support * stretch.eigenvectors();
  const Eigen::VectorXd excess = stretch.eigenvalues().cwiseMin(kLargestStretch).array() - 1.0;
  return Eigen::MatrixXd::Identity(dim, dim) + axes * excess.asDiagonal() * axes.transpose();
}

double spread_w2(const Eigen::MatrixXd& from, const Eigen::MatrixXd& spread) {
  const Eigen::MatrixXd moved = spread - Eigen::MatrixXd::Identity(from.rows(), from.cols());
  return std::sqrt(std::max(0.0, (moved * from * moved.transpose()).trace()));
}

}  // namespace qsmpc
