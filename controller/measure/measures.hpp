// The two kinds of probability measure that the controller computes with.
#pragma once

#include <Eigen/Core>

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// Points of a discrete measure: one coordinate per row, one point per column.
using Points = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// N(mean, covariance); the covariance may be singular.
struct Gaussian {
  Eigen::VectorXd mean;        ///< d
  Eigen::MatrixXd covariance;  ///< d x d, symmetric, positive semidefinite
};

/// Σ weights_i δ(locations_i).
struct DiscreteMeasure {
  Points locations;         ///< d x n
  Eigen::VectorXd weights;  ///< n, non-negative, sums to one

  [[nodiscard]] Eigen::Index dim() const { return locations.rows(); }
  [[nodiscard]] Eigen::Index size() const { return locations.cols(); }
};

/// Throws std::invalid_argument unless the sizes agree, all entries are finite and the covariance
/// is symmetric and positive semidefinite (to 1e-9 of its largest entry).
void check_gaussian(const Gaussian& gaussian);

/// Throws std::invalid_argument unless there is at least one point, the sizes agree, all locations
/// are finite, no weight is negative and the weights sum to one (to 1e-9).
void check_measure(const DiscreteMeasure& measure);

/// Σ π_i c_i (d).
[[nodiscard]] Eigen::VectorXd mean_of(const DiscreteMeasure& measure);

/// Σ π_i (c_i − m)(c_i − m)ᵀ (d x d).
[[nodiscard]] Eigen::MatrixXd covariance_of(const DiscreteMeasure& measure);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
