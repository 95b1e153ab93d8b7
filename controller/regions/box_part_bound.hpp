// Upper bounds of P(z + e ∈ part) for a half-space or a box, z Gaussian and e an
// error of known mean square in each coordinate: bounds C3 and C4 of docs/theory/surrogate.md.
#pragma once

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/regions/box_part.hpp"

namespace qsmpc::controller {

/// z ~ law, |e_a| of root mean square at most error_a, and n ~ N(0, smoothing) a part of z that is
/// independent of z − n and of e.
struct PerturbedGaussian {
  const Gaussian& law;
  const Eigen::VectorXd& error;
  const Eigen::MatrixXd& smoothing;
};

/// C3: min over t of E|e|²/t² + E(1 − d(z, part)²/t²)₊, with e in the part's coordinates only.
/// useful: a bound that cannot be below this (> 0) is not searched for, and 1 is returned.
[[nodiscard]] double markov_region_bound(const PerturbedGaussian& state, const BoxPart& part,
                                         double useful = 1.0);

/// C4: P(z ∈ part) and the first two orders in e of the probability smoothed by n,
///     P(z ∈ part) + Σ_a error_a ‖∂_a h‖ + 0.242 E[eᵀ N⁻¹ e],  h(y) = P(y + n ∈ part),
/// minimised over the part's coordinates and pairs of coordinates.
[[nodiscard]] double smooth_region_bound(const PerturbedGaussian& state, const BoxPart& part);

}  // namespace qsmpc::controller
