// The loops over the samples of a chunk, except those of the system, for the processor's widest
// vectors. Results do not depend on the vector width.
#pragma once

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/planning/cost/stage_kernels.hpp"
#include "controller/regions/disc_placement.hpp"

namespace qsmpc::controller {

/// How one input of one stage is drawn: u = clamp(nominal + deviation · drift), where drift ← keep
/// · drift + add · ξ.
struct InputDraw {
  double nominal = 0.0;
  double deviation = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  double keep = 0.0;
  double add = 1.0;
};

/// Replaces `count` standard normal numbers ξ by inputs, and updates their drifts.
void draw_inputs(const InputDraw& draw, Eigen::Index count, double* drift, double* values);

/// totals_i += factor · (x_i − r)ᵀW(x_i − r) for the columns x_i of `points`.
void add_quadratic(const QuadraticForm& form, double factor, const Eigen::Ref<const Points>& points,
                   Eigen::ArrayXd& totals);

/// The centres of a disc that is offset from the position; `centres` is sized by the caller.
void place_discs(const DiscPlacement& placement, const Points& states, Points& centres);

/// The cost of a stage at a clearance s (m) of the body: `collision` where s ≤ 0, plus `proximity`
/// · h(s / margin), with h as in planning/cost/penalty.hpp.
struct UnsafeCost {
  double collision = 0.0;
  double proximity = 0.0;
  double margin = 1.0;  ///< m, > 0
};

/// totals_i += the cost at clearances_i.
void add_unsafe_cost(const UnsafeCost& cost, const Eigen::ArrayXd& clearances, double* totals);

/// Σ a_i b_i of `count` numbers.
[[nodiscard]] double weighted_total(const double* a, const double* b, Eigen::Index count);

}  // namespace qsmpc::controller
