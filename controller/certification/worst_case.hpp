// The largest probability of the unsafe set over a Wasserstein ball about a discrete measure
// (Eq. 4-14).
#pragma once

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

/// sup { Q(unsafe) : W2(Q, P) ≤ radius } for P = Σ weights_i δ with the given distances to the
/// unsafe set (≥ 0; as many as weights). Exact: moving mass m over a distance d costs m d², and the
/// nearest mass is moved first, until radius² is spent (docs/theory/certificates.md, section 2).
/// Throws std::invalid_argument if sizes differ, a weight or distance is negative or NaN, or
/// radius < 0 or NaN; an infinite radius gives 1.
[[nodiscard]] double worst_case_probability(const Eigen::Ref<const Eigen::VectorXd>& distances,
                                            const Eigen::Ref<const Eigen::VectorXd>& weights,
                                            double radius);

/// The same with the distances of the measure's points to the unsafe set (C1).
[[nodiscard]] double worst_case_probability(const DiscreteMeasure& measure, const UnsafeSet& unsafe,
                                            double radius);

/// The mass, at most 1, that can be moved at these unit costs (≥ 0) within `budget`, the cheapest
/// first. Mass of infinite unit cost cannot be moved.
[[nodiscard]] double transported_mass(const Eigen::Ref<const Eigen::VectorXd>& unit_costs,
                                      const Eigen::Ref<const Eigen::VectorXd>& weights,
                                      double budget);

}  // namespace qsmpc::controller
