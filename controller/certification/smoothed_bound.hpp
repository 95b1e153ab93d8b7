// Upper bounds of P(x ∈ U) for x = y + e, where y is a Gaussian mixture and e any error of known
// mean square: bound C2, and the form that C3 takes (docs/theory/certificates.md, section 3).
//
// If y + e is unsafe, then |e| is at least the distance d(y) to the unsafe set, so for every t > 0
//     1{y + e ∈ U} ≤ (1 − d(y)²/t²)₊ + |e|²/t²,
// hence P(x ∈ U) ≤ E(1 − d(y)²/t²)₊ + E|e|²/t². The expectation has a closed form for each face of
// the safe set; U is a union, so the parts are added.
#pragma once

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

/// Upper bound of E(1 − d(y, U)²/t²)₊ for y ~ N(mean, covariance) and U the unsafe set at `stage`;
/// discs of the body away from its position are turned by the heading of `mean`, not of y. t > 0.
[[nodiscard]] double soft_unsafe_probability(const Eigen::Ref<const Eigen::VectorXd>& mean,
                                             const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                             const UnsafeSet& unsafe, double t,
                                             Eigen::Index stage = 0);

/// Σ weights_i N(centre_i, covariance); refers to objects that must outlive it.
struct GaussianMixture {
  const Points& centres;           ///< state_dim x n
  const Eigen::VectorXd& weights;  ///< n
  const Eigen::MatrixXd& covariance;
};

/// An upper bound of P(y + e ∈ U) for y ~ mixture and any e with E|e|² ≤ state_radius²: the least
/// value found in a search over t, each of which is a bound. 1 if no value below `useful_below` is
/// possible.
[[nodiscard]] double smoothed_probability(const GaussianMixture& mixture, const UnsafeSet& unsafe,
                                          double state_radius, double useful_below = 1.0,
                                          Eigen::Index stage = 0);

}  // namespace qsmpc::controller
