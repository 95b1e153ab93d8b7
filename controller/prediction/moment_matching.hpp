// Restores a covariance by moving points: the linear map between two covariances that moves points
// least.
#pragma once

#include <Eigen/Core>

namespace qsmpc::controller {

/// The largest stretch of a direction. A quantiser with two points along an axis loses a third of
/// its variance, which a stretch by 1.25 restores; where more than this is needed, the points do
/// not represent the direction, and stretching would only amplify artefacts.
inline constexpr double kLargestStretch = 2.0;

/// The symmetric positive definite S with S·from·S = to, that is
/// S = from^−½ (from^½ to from^½)^½ from^−½: of all maps between measures of these covariances it
/// moves points least in the mean square (the optimal transport between Gaussians). Directions in
/// which `from` has no variance are unchanged, and eigenvalues of S are at most kLargestStretch;
/// apart from these two, the covariance is met exactly. from, to: d x d, symmetric, positive
/// semidefinite.
[[nodiscard]] Eigen::MatrixXd spread_between(const Eigen::MatrixXd& from,
                                             const Eigen::MatrixXd& to);

/// The same, written to `out`. Allocates nothing up to eight dimensions, if `out` has the size.
void spread_between(const Eigen::MatrixXd& from, const Eigen::MatrixXd& to, Eigen::MatrixXd& out);

/// √tr((S − I)·from·(S − I)): the root mean square of how far the points of a measure with the
/// covariance `from` move under x ↦ m + S (x − m), m their mean.
[[nodiscard]] double spread_w2(const Eigen::MatrixXd& from, const Eigen::MatrixXd& spread);

}  // namespace qsmpc::controller
