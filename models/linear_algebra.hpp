// Decompositions of small dense matrices, each compiled only once: an Eigen decomposition adds ten
// seconds of compilation to every source that uses it.
#pragma once

#include <Eigen/Core>

namespace qsmpc::models {

/// Eigenvalues, ascending, and orthonormal eigenvectors of a symmetric matrix: M vᵢ = λᵢ vᵢ.
struct SymmetricEigen {
  Eigen::VectorXd values;   ///< n
  Eigen::MatrixXd vectors;  ///< n x n, vᵢ in column i
};

/// Eigendecomposition of a symmetric matrix (n x n, finite); only the lower triangle is read.
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);

/// The eigenvalues only, ascending; NaN if the iteration has not converged.
[[nodiscard]] Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

/// The largest singular value of `matrix`.
[[nodiscard]] double spectral_norm(const Eigen::MatrixXd& matrix);

/// The least-squares solution x of `matrix` · x = `values` with the smallest norm (complete
/// orthogonal decomposition).
[[nodiscard]] Eigen::VectorXd smallest_solution(const Eigen::MatrixXd& matrix,
                                                const Eigen::VectorXd& values);

/// The Moore-Penrose inverse (complete orthogonal decomposition).
[[nodiscard]] Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix);

/// The lower Cholesky factor L of a symmetric positive definite matrix = L Lᵀ; only the lower
/// triangle is read.
[[nodiscard]] Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& matrix);

/// The solution of a symmetric semidefinite system `matrix` · x = `values` (LDLᵀ, pivoted).
[[nodiscard]] Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& matrix,
                                              const Eigen::VectorXd& values);

/// A solution of the square system `matrix` · x = `values` by Gaussian elimination with full
/// pivoting.
[[nodiscard]] Eigen::VectorXd solve_fully_pivoted(const Eigen::MatrixXd& matrix,
                                                  const Eigen::VectorXd& values);

/// The rank of a matrix, and a column that depends linearly on the others.
struct ColumnRank {
  Eigen::Index rank = 0;
  Eigen::Index dependent = -1;  ///< index of that column; -1 if all are independent
};

/// Pivots below `threshold` times the largest count as zero.
[[nodiscard]] ColumnRank column_rank(const Eigen::MatrixXd& matrix, double threshold);

/// The orthogonal factor Q of matrix = Q R.
[[nodiscard]] Eigen::MatrixXd orthogonal_factor(const Eigen::MatrixXd& matrix);

}  // namespace qsmpc::models
