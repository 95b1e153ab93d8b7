// The 2-Wasserstein distance between two measures of the same kind:
//
//   W2(P, Q)² = min over the couplings of P and Q of E|x − y|².
#pragma once

#include "controller/measure/measures.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// W2 of two discrete measures in the same space: the transport problem is solved by the network
/// simplex method, in integers, so that it ends at an optimal plan. Points of weight zero are
/// ignored.
///
/// Effects of rounding: masses are doubles, known to about 1e-16 of the total; squared distances
/// are compared in fixed point, with a resolution of 1e-14 of the largest one, D². The cost of the
/// plan is then summed in double precision. So the square of the result is within about 1e-14·D² of
/// W2², which matters only where W2 itself is below 1e-5·D.
///
/// Takes about 100 bytes of memory per pair of points. Throws std::invalid_argument if the
/// dimensions differ or as check_measure; std::length_error above kTransportPairs pairs.
[[nodiscard]] double wasserstein2(const DiscreteMeasure& first, const DiscreteMeasure& second);

/// The largest number of pairs of points with weight that `wasserstein2` accepts.
inline constexpr Eigen::Index kTransportPairs = 20'000'000;

/// W2 of two Gaussians, which may be singular (Bures):
/// W2² = |m₁ − m₂|² + tr(Σ₁ + Σ₂ − 2 (Σ₁^½ Σ₂ Σ₁^½)^½). Computed as |m₁ − m₂|² + min |R₁ − R₂ Q|²
/// over the orthogonal Q, with R Rᵀ = Σ, where nothing cancels when the two are close. Throws
/// std::invalid_argument if the dimensions differ or as check_gaussian.
[[nodiscard]] double wasserstein2(const Gaussian& first, const Gaussian& second);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
