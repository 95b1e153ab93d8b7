#include "models/linear_algebra.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

#include "models/constants.hpp"

namespace qsmpc::models {

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return {.values = solver.eigenvalues(), .vectors = solver.eigenvectors()};
}

Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix, Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success) {
    return Eigen::VectorXd::Constant(matrix.rows(), kNotANumber);
  }
  return solver.eigenvalues();
}

double spectral_norm(const Eigen::MatrixXd& matrix) { return matrix.operatorNorm(); }

Eigen::VectorXd smallest_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& values) {
  return matrix.completeOrthogonalDecomposition().solve(values);
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix) {
  return matrix.completeOrthogonalDecomposition().pseudoInverse();
}

Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& matrix) { return matrix.llt().matrixL(); }

Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& values) {
  return matrix.ldlt().solve(values);
}

Eigen::VectorXd solve_fully_pivoted(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& values) {
  return matrix.fullPivLu().solve(values);
}

ColumnRank column_rank(const Eigen::MatrixXd& matrix, double threshold) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix);
  qr.setThreshold(threshold);
  ColumnRank result{.rank = qr.rank()};
  if (result.rank < matrix.cols()) {
    result.dependent = qr.colsPermutation().indices()[result.rank];
  }
  return result;
}

Eigen::MatrixXd orthogonal_factor(const Eigen::MatrixXd& matrix) {
  return Eigen::HouseholderQR<Eigen::MatrixXd>(matrix).householderQ();
}

}  // namespace qsmpc::models
