// The law of the state at one stage as a prediction method represents it: points, a mixture of
// Gaussians, or a polynomial of standard normals.
//
//   const StageLaw law = gaussian_law({.mean = m, .covariance = p});
//   unsafe_probability(law, unsafe, quasi_random_draws(law_dim(law), 1 << 17));
#pragma once

#include <variant>
#include <vector>

#include <Eigen/Core>

#include "controller/laws/hermite_expansion.hpp"
#include "controller/laws/standard_draws.hpp"
#include "controller/measure/measures.hpp"
#include "controller/regions/unsafe_set.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// Σ weights_i N(means_i, covariances_i).
struct GaussianMixture {
  Eigen::VectorXd weights;                   ///< n, positive, sums to one
  Points means;                              ///< dim x n
  std::vector<Eigen::MatrixXd> covariances;  ///< n, dim x dim each, may be singular

  [[nodiscard]] Eigen::Index dim() const { return means.rows(); }
  [[nodiscard]] Eigen::Index size() const { return means.cols(); }
};

using StageLaw = std::variant<DiscreteMeasure, GaussianMixture, HermiteExpansion>;

/// A mixture of one component.
[[nodiscard]] StageLaw gaussian_law(const Gaussian& gaussian);

/// The law of a prediction that is not finite: one NaN point.
[[nodiscard]] StageLaw lost_law(Eigen::Index dim);

[[nodiscard]] Eigen::Index law_dim(const StageLaw& law);
[[nodiscard]] bool is_finite(const StageLaw& law);

/// The mean (dim), exactly.
[[nodiscard]] Eigen::VectorXd mean_of(const StageLaw& law);

/// The covariance (dim x dim), exactly: of a mixture, that of the components and of their means.
[[nodiscard]] Eigen::MatrixXd covariance_of(const StageLaw& law);

/// The draws of the law made from `draws` (of its dimension), dim x count. Components are chosen in
/// order, by their cumulative weights.
[[nodiscard]] Points law_draws(const StageLaw& law, const StandardDraws& draws);

/// The probability of the unsafe set at `stage`: exact for points; otherwise the share of the law's
/// `draws` that are unsafe, which cannot resolve probabilities below one over their number. A law
/// that is not finite counts as unsafe.
[[nodiscard]] double unsafe_probability(const StageLaw& law, const UnsafeSet& unsafe,
                                        const StandardDraws& draws, Eigen::Index stage = 0);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
