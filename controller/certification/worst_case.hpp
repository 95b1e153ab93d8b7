// The largest probability of the unsafe set over a Wasserstein ball about a discrete measure
// (Eq. 4-14).
#pragma once

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/planning/safe_set.hpp"

namespace qsmpc::controller {

/// sup { Q(unsafe) : W2(Q, P) ≤ radius } for P = Σ weights_i δ with the given distances to the
/// unsafe set (≥ 0; as many as weights). Exact: moving mass m over a distance d costs m d², and
/// what is nearest is moved first, until radius² is spent (docs/theory/certificates.md, section 2).
/// Throws std::invalid_argument if sizes differ, a weight or distance is negative or NaN, or
/// radius < 0 or NaN; an infinite radius gives 1.
[[nodiscard]] double worst_case_probability(const Eigen::Ref<const Eigen::VectorXd>& distances,
                                            const Eigen::Ref<const Eigen::VectorXd>& weights,
                                            double radius);

/// The same with the distances of the measure's points to the unsafe set (C1).
[[nodiscard]] double worst_case_probability(const DiscreteMeasure& measure, const SafeSet& safe_set,
                                            double radius);

/// Algorithms 3 and 4 of the thesis as printed, for comparison only: NOT an upper bound. The
/// distance is a norm over the dimensions of the distances to the faces, which overestimates it,
/// and obstacles do not count. (Spending d·m against the radius, instead of d²·m against its
/// square, is loose only.)
[[nodiscard]] double thesis_probability(const DiscreteMeasure& measure, const SafeSet& safe_set,
                                        double radius);

/// Algorithm 4 with the true distance in place of Algorithm 3's: spends d·m against the radius. The
/// ball of that radius in W1 contains the one in W2, as W1 ≤ W2, so this is never below C1.
[[nodiscard]] double linear_transport_probability(const DiscreteMeasure& measure,
                                                  const SafeSet& safe_set, double radius);

}  // namespace qsmpc::controller
