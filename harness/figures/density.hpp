// Densities of weighted samples, for drawing: Gaussian kernel estimates in one and two dimensions
// and the regions of highest density.
//
//   const DensityGrid grid = density_grid(points, weights);
//   for (const DensityContour& contour : density_contours(grid, {0.5, 0.95})) ...
//
// The estimate is Σ w_i N(x; x_i, h² S) with S the sample's covariance and Scott's factor
// h = n^(−1/(d + 4)), n = (Σ w)² / Σ w² the effective size (D. W. Scott, Multivariate Density
// Estimation, 1992). S is that of reliability weights, Σ w_i (x_i − m)(x_i − m)ᵀ / (1 − Σ w_i²) for
// weights that sum to one: the same numbers as scipy.stats.gaussian_kde gives. Where the sample has
// next to no spread in a direction, S is raised there, so that the estimate exists.
//
// Weights need not sum to one; an empty vector stands for equal ones. Every function throws
// std::invalid_argument if there is no point, the sizes differ, a value is not finite, a weight is
// negative or all are 0.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace qsmpc::harness {

/// (Σ w)² / Σ w²: how many equally weighted points are as informative.
[[nodiscard]] double effective_size(const Eigen::Ref<const Eigen::VectorXd>& weights);

/// The estimate from `sample` (n) at each of `at`.
[[nodiscard]] Eigen::VectorXd kernel_density(const Eigen::Ref<const Eigen::VectorXd>& sample,
                                             const Eigen::Ref<const Eigen::VectorXd>& weights,
                                             const Eigen::Ref<const Eigen::VectorXd>& at);

/// A density over a line, ready to be a chart's series.
struct DensityCurve {
  std::vector<double> x;
  std::vector<double> density;  ///< as many, per unit of x
};

/// The estimate at `count` ≥ 2 equally spaced places that reach past the sample by 4 standard
/// deviations of the kernel, beyond which next to nothing of the mass lies.
[[nodiscard]] DensityCurve density_curve(const Eigen::Ref<const Eigen::VectorXd>& sample,
                                         const Eigen::Ref<const Eigen::VectorXd>& weights,
                                         int count = 200);

/// A density over a part of the plane. Its grid is that of the sample's principal axes, each in
/// units of its standard deviation, so that it resolves the narrowest sample in any direction.
struct DensityGrid {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();     ///< the sample's mean
  Eigen::Matrix2d basis = Eigen::Matrix2d::Identity();  ///< columns: principal axes
  Eigen::VectorXd u{};  ///< equally spaced coordinates along the first axis
  Eigen::VectorXd v{};  ///< along the second one
  Eigen::MatrixXd
      density{};  ///< u.size() x v.size(), per unit of area, at centre + basis (u_i, v_j)

  /// Area of the plane that stands for one node.
  [[nodiscard]] double cell_area() const;
};

/// The estimate from `points` (2 x n) on a grid of `count` x `count` ≥ 2 x 2 nodes that reaches
/// past all points by 4 standard deviations of the kernel.
[[nodiscard]] DensityGrid density_grid(const Eigen::Ref<const Eigen::Matrix2Xd>& points,
                                       const Eigen::Ref<const Eigen::VectorXd>& weights,
                                       int count = 128);

/// The level l for which {density ≥ l}, the smallest region of that mass, holds the part `mass`
/// (0 < mass < 1) of the grid's mass. Throws std::invalid_argument for another `mass`.
[[nodiscard]] double highest_density_level(const DensityGrid& grid, double mass);

/// One closed line about (or of a hole in) a region of highest density.
struct DensityContour {
  double mass = 0.0;          ///< of the region
  Eigen::Matrix2Xd points{};  ///< the first one is repeated at the end
};

/// The boundaries of the regions of highest density that hold each of `masses`, as in
/// highest_density_level. A region of several parts has several lines.
[[nodiscard]] std::vector<DensityContour> density_contours(const DensityGrid& grid,
                                                           const std::vector<double>& masses);

}  // namespace qsmpc::harness
