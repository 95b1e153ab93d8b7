// Turns a Gaussian into a discrete measure with a known error: either a product of optimal
// one-dimensional quantisers on the axes of the covariance's eigenbasis or, with fewer points for
// the same error, points placed by Lloyd's method.
//
//   const GaussianQuantisation q = quantise(belief, 100);
//   q.measure;  // at most 100 weighted points, with the belief's mean
//   q.w2;       // its exact 2-Wasserstein distance to the belief
//
//   quantise(belief, 100, QuantiserKind::kLloyd).w2;  // a bound on it; no larger than the former
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

enum class QuantiserKind {
  kProduct,  ///< a grid: microseconds
  kLloyd,    ///< centroidal: 8 to 11 % less W2 in two or three dimensions, but a slow first call
};

struct QuantiserEntry {
  std::string name;
  std::string summary;
  QuantiserKind kind = QuantiserKind::kProduct;
};

/// The table of quantisers: "product" and "lloyd".
[[nodiscard]] const std::vector<QuantiserEntry>& quantisers();

/// Throws std::invalid_argument on an unknown name.
[[nodiscard]] QuantiserKind quantiser_kind(std::string_view name);

struct GaussianQuantisation {
  DiscreteMeasure measure;
  /// W2 to the Gaussian. Exact for a product, whose cells are the points' Voronoi cells; otherwise
  /// the cost of a coupling, hence an upper bound.
  double w2 = 0.0;
  Eigen::MatrixXd within_covariance;  ///< d x d; covariance = cov(measure) + within_covariance
  /// Points on each eigenaxis, eigenvalues increasing, for a product; otherwise empty.
  std::vector<int> levels;
};

/// Levels n_j ≥ 1 with Π n_j ≤ budget that minimise Σ variances_j D(n_j), D the distortion of the
/// optimal one-dimensional quantiser (beyond kExactDistortions points its asymptote): by a complete
/// search over shapes whose levels do not increase as the variance decreases. Axes of zero variance
/// get one level. Throws std::invalid_argument if budget < 1 or a variance is negative or not
/// finite.
[[nodiscard]] std::vector<int> allot_levels(const Eigen::Ref<const Eigen::VectorXd>& variances,
                                            int budget);

/// The best quantiser of `gaussian` of this kind with at most `budget` points. Its points are
/// conditional means, so the mean is kept exactly, and W2² = tr(within_covariance), exactly or as a
/// bound (docs/theory/quantisation.md).
///
/// kProduct: Σ λ_j D(n_j) with the levels of `allot_levels`.
///
/// kLloyd: scaled `normal_lloyd` points on those eigenaxes of largest variance for which the
/// expected gain is greatest, and levels on the others; the product if there is no gain, as on the
/// line or where more than kLloydPoints points would be needed. So its w2 never exceeds the
/// product's. The first call for a given number of axes and points takes as long as `normal_lloyd`;
/// later calls, for any Gaussian, take about as long as the product. Hence it is not for a control
/// loop whose covariance changes shape, unless those first calls are made before it starts.
///
/// Throws std::invalid_argument as check_gaussian and allot_levels.
[[nodiscard]] GaussianQuantisation quantise(const Gaussian& gaussian, int budget,
                                            QuantiserKind kind = QuantiserKind::kProduct);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
