// The thesis's figures for a plan's safety, for reproductions and comparisons: NOT bounds.
#pragma once

#include <vector>

#include "controller/certification/error_budget.hpp"
#include "controller/measure/measures.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

/// The radii of the thesis at stages 0 … horizon, by Eq. 4-4 and 4-6: without noise and without
/// feedback, hence too small. Where no global Lipschitz constant is known, that of the closed loop
/// on its region is used. budgets: as for `certify`.
[[nodiscard]] std::vector<double> thesis_radii(const PredictedMotion& motion,
                                               const std::vector<StageBudget>& budgets);

/// Algorithms 3 and 4 of the thesis as printed: NOT an upper bound. The distance is the norm, over
/// the dimensions, of the distances to the faces, which overestimates it; obstacles and the body
/// are ignored: the vehicle is a point.
/// (Spending d·m against the radius, instead of d²·m against its square, only makes the result
/// loose.)
[[nodiscard]] double thesis_probability(const DiscreteMeasure& measure, const Box& bounds,
                                        double radius);

/// Algorithm 4 with the true distance in place of Algorithm 3's: spends d·m against the radius. The
/// ball of that radius in W1 contains the one in W2, as W1 ≤ W2, so this is never below C1.
[[nodiscard]] double linear_transport_probability(const DiscreteMeasure& measure,
                                                  const UnsafeSet& unsafe, double radius);

}  // namespace qsmpc::controller
