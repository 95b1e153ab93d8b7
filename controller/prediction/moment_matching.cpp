#include "controller/prediction/moment_matching.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "models/linear_algebra.hpp"

namespace qsmpc::controller {
namespace {

// Eigenvalues below this fraction of the largest are rounding.
constexpr double kNoVariance = 1e-12;

// Up to this dimension everything stays on the stack.
constexpr int kSmall = 8;
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kSmall, kSmall>;
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kSmall, 1>;

struct SmallEigen {
  SmallVector values;
  SmallMatrix vectors;
};

SmallEigen eigen_of(const SmallMatrix& matrix) {
  const Eigen::SelfAdjointEigenSolver<SmallMatrix> solver(matrix);
  return {.values = solver.eigenvalues(), .vectors = solver.eigenvectors()};
}

models::SymmetricEigen eigen_of(const Eigen::MatrixXd& matrix) {
  return models::symmetric_eigen(matrix);
}

template <class Matrix>
Matrix symmetric(const Matrix& matrix) {
  return 0.5 * (matrix + matrix.transpose());
}

template <class Matrix, class Vector>
void spread(const Matrix& from, const Matrix& to, Eigen::MatrixXd& out) {
  const Eigen::Index dim = from.rows();
  const auto eigen = eigen_of(from);
  const double least = kNoVariance * eigen.values[dim - 1];
  Eigen::Index null = 0;  // eigenvalues increase
  while (null < dim && eigen.values[null] <= least) ++null;
  const Eigen::Index rank = dim - null;
  out.setIdentity(dim, dim);
  if (rank == 0) return;
  // In the coordinates of the support U, where U'·from·U is diagonal.
  const Matrix support = eigen.vectors.rightCols(rank);
  const Vector deviation = eigen.values.tail(rank).cwiseSqrt();
  const Matrix reached = to * support;
  const Matrix projected = support.transpose() * reached;
  const Matrix scaled_target = deviation.asDiagonal() * projected * deviation.asDiagonal();
  const auto target = eigen_of(symmetric<Matrix>(scaled_target));
  const Vector roots = target.values.cwiseMax(0.0).cwiseSqrt();
  const Matrix stretched = target.vectors * roots.asDiagonal();
  const Matrix root = stretched * target.vectors.transpose();
  const Vector inverse = deviation.cwiseInverse();
  const Matrix scaled_root = inverse.asDiagonal() * root * inverse.asDiagonal();
  const auto stretch = eigen_of(symmetric<Matrix>(scaled_root));
  const Matrix directions = support * stretch.vectors;
  const Vector excess = stretch.values.cwiseMin(kLargestStretch).array() - 1.0;
  const Matrix weighted = directions * excess.asDiagonal();
  out.noalias() += weighted * directions.transpose();
}

}  // namespace

void spread_between(const Eigen::MatrixXd& from, const Eigen::MatrixXd& to, Eigen::MatrixXd& out) {
  if (from.rows() <= kSmall) {
    spread<SmallMatrix, SmallVector>(from, to, out);
  } else {
    spread<Eigen::MatrixXd, Eigen::VectorXd>(from, to, out);
  }
}

Eigen::MatrixXd spread_between(const Eigen::MatrixXd& from, const Eigen::MatrixXd& to) {
  Eigen::MatrixXd result;
  spread_between(from, to, result);
  return result;
}

double spread_w2(const Eigen::MatrixXd& from, const Eigen::MatrixXd& spread) {
  double sum = 0.0;
  for (Eigen::Index a = 0; a < from.rows(); ++a) {
    for (Eigen::Index b = 0; b < from.rows(); ++b) {
      const double left = spread(a, b) - (a == b ? 1.0 : 0.0);
      for (Eigen::Index c = 0; c < from.rows(); ++c) {
        sum += left * from(b, c) * (spread(a, c) - (a == c ? 1.0 : 0.0));
      }
    }
  }
  return std::sqrt(std::max(0.0, sum));
}

}  // namespace qsmpc::controller
