// The 2-Wasserstein distance between two measures of the same kind:
//
//   W2(P, Q)² = min over the couplings of P and Q of E|x − y|².
#pragma once

#include "controller/measure/measures.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// W2 of two discrete measures in the same space: the transport problem is solved by the network
/// simplex method, in integers, so that it ends at an optimal plan. Points without weight take no
/// part.
///
/// What rounding leaves: masses are doubles, and are known to about 1e-16 of the whole; squared
/// distances are compared in fixed point, 1e-14 of the largest one, D², apart. The cost of the plan
/// is then summed in double precision. So the square of the result is within about 1e-14·D² of
/// W2², which matters only where W2 itself is below 1e-5·D.
///
/// Takes about 100 bytes of memory for a pair of points. Throws std::invalid_argument if the
/// dimensions differ or as check_measure; std::length_error above kTransportPairs pairs.
[[nodiscard]] double wasserstein2(const DiscreteMeasure& first, const DiscreteMeasure& second);

/// Up to how many pairs of points with weight `wasserstein2` goes.
inline constexpr Eigen::Index kTransportPairs = 20'000'000;

/// W2 of two Gaussians, which may be singular (Bures):
/// W2² = |m₁ − m₂|² + tr(Σ₁ + Σ₂ − 2 (Σ₁^½ Σ₂ Σ₁^½)^½). Computed as |m₁ − m₂|² + min |R₁ − R₂ Q|²
/// over the orthogonal Q, with R Rᵀ = Σ, where nothing cancels when the two are close. Throws
/// std::invalid_argument if the dimensions differ or as check_gaussian.
[[nodiscard]] double wasserstein2(const Gaussian& first, const Gaussian& second);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
