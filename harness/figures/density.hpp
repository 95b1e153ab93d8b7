// Densities of weighted samples, for drawing: Gaussian kernel estimates in one and two dimensions
// and the regions of highest density.
//
//   const DensityGrid grid = density_grid(points, weights);
//   for (const DensityContour& contour : density_contours(grid, {0.5, 0.95})) ...
//
// The estimate is Σ w_i N(x; x_i, h² S) with the sample covariance S and Scott's factor
// h = n^(−1/(d + 4)), n = (Σ w)² / Σ w² the effective size (D. W. Scott, Multivariate Density
// Estimation, 1992). S is the covariance for reliability weights, Σ w_i (x_i − m)(x_i − m)ᵀ / (1 −
// Σ w_i²) for weights that sum to one, as in scipy.stats.gaussian_kde. In directions of almost no
// spread, S is raised so that the estimate exists.
//
// Weights need not sum to one; an empty vector stands for equal weights. Every function throws
// std::invalid_argument if there are no points, the sizes differ, a value is not finite, a weight
// is negative or all weights are 0.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace qsmpc::harness {

/// (Σ w)² / Σ w²: the number of equally weighted points that carry the same information.
[[nodiscard]] double effective_size(const Eigen::Ref<const Eigen::VectorXd>& weights);

/// The estimate from `sample` (n) at each point of `at`.
[[nodiscard]] Eigen::VectorXd kernel_density(const Eigen::Ref<const Eigen::VectorXd>& sample,
                                             const Eigen::Ref<const Eigen::VectorXd>& weights,
                                             const Eigen::Ref<const Eigen::VectorXd>& at);

/// A density on a line, ready for use as a chart's series.
struct DensityCurve {
  std::vector<double> x;
  std::vector<double> density;  ///< as many as x, per unit of x
};

/// The estimate at `count` ≥ 2 equally spaced points. They extend beyond the sample by 4 standard
/// deviations of the kernel, outside of which there is almost no mass.
[[nodiscard]] DensityCurve density_curve(const Eigen::Ref<const Eigen::VectorXd>& sample,
                                         const Eigen::Ref<const Eigen::VectorXd>& weights,
                                         int count = 200);

/// A density on a part of the plane. Its grid is aligned with the sample's principal axes, each in
/// units of its standard deviation, so that it resolves even a narrow sample in any direction.
struct DensityGrid {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();     ///< the sample's mean
  Eigen::Matrix2d basis = Eigen::Matrix2d::Identity();  ///< columns: principal axes
  Eigen::VectorXd u{};  ///< equally spaced coordinates along the first axis
  Eigen::VectorXd v{};  ///< along the second axis
  Eigen::MatrixXd
      density{};  ///< u.size() x v.size(), per unit of area, at centre + basis (u_i, v_j)

  /// Area of the plane per node.
  [[nodiscard]] double cell_area() const;
};

/// The estimate from `points` (2 x n) on a grid of `count` x `count` ≥ 2 x 2 nodes that extends
/// beyond all points by 4 standard deviations of the kernel.
[[nodiscard]] DensityGrid density_grid(const Eigen::Ref<const Eigen::Matrix2Xd>& points,
                                       const Eigen::Ref<const Eigen::VectorXd>& weights,
                                       int count = 128);

/// The level l for which {density ≥ l}, the smallest region of its mass, holds the share `mass` (0
/// < mass < 1) of the grid's mass. Throws std::invalid_argument for any other `mass`.
[[nodiscard]] double highest_density_level(const DensityGrid& grid, double mass);

/// One closed line: the outer boundary of a highest-density region, or that of a hole in it.
struct DensityContour {
  double mass = 0.0;          ///< of the region
  Eigen::Matrix2Xd points{};  ///< the first is repeated at the end
};

/// The boundaries of the highest-density regions of each of `masses`, see highest_density_level. A
/// region of several parts has several lines.
[[nodiscard]] std::vector<DensityContour> density_contours(const DensityGrid& grid,
                                                           const std::vector<double>& masses);

}  // namespace qsmpc::harness
