// Upper bounds of P(z + e ∈ part) for a half-space or a box, z Gaussian and e an error whose norms
// of higher order are known: bound C3 of docs/theory/surrogate.md.
#pragma once

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/regions/box_part.hpp"

namespace qsmpc::controller {

/// C3 by a norm of higher order: min over τ of |axes| τ^−p + P(z ∈ part widened by τ · norms),
/// since P(|e_a| > τ ‖e_a‖_p) ≤ τ^−p in each of the part's coordinates. norms: bounds of ‖e_a‖_p
/// (dim). useful: a bound that cannot be below this (> 0) is not searched for, and 1 is returned.
[[nodiscard]] double tail_region_bound(const Gaussian& law, const Eigen::VectorXd& norms, int order,
                                       const BoxPart& part, double useful = 1.0);

/// The same with the single τ that leaves half of `enough` (> 0) to the tails: as good as a search
/// if the result is at most `enough`. Returns 1 if the part is too near for this τ to be useful.
[[nodiscard]] double far_region_bound(const Gaussian& law, const Eigen::VectorXd& norms, int order,
                                      const BoxPart& part, double enough);

}  // namespace qsmpc::controller
