// The planning penalties at the particles of one stage, bounds included, in the form in which loops
// over regions and the thesis's penalty take them.
#pragma once

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/parallel.hpp"
#include "controller/planning/cost/penalty.hpp"
#include "controller/regions/safe_set.hpp"

namespace qsmpc::testing {

struct PenaltyValue {
  double box = 0.0;
  double obstacle = 0.0;
};

/// Penalty of the particles of `range`; the gradient is added to `adjoint` (d x n).
[[nodiscard]] PenaltyValue add_penalty(const controller::Points& locations,
                                       const Eigen::VectorXd& weights,
                                       const controller::SafeSet& safe_set,
                                       const controller::Penalty& penalty,
                                       controller::Points& adjoint,
                                       controller::ParticleRange range);

/// Penalty of all particles.
[[nodiscard]] PenaltyValue add_penalty(const controller::Points& locations,
                                       const Eigen::VectorXd& weights,
                                       const controller::SafeSet& safe_set,
                                       const controller::Penalty& penalty,
                                       controller::Points& adjoint);

}  // namespace qsmpc::testing
