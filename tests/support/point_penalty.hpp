// The penalties of planning at the particles of one stage, bounds included, as loops over regions
// and the printed shapes take them.
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

/// Of the particles of `range`; the gradient is added to `adjoint` (d x n).
[[nodiscard]] PenaltyValue add_penalty(const controller::Points& locations,
                                       const Eigen::VectorXd& weights,
                                       const controller::SafeSet& safe_set,
                                       const controller::Penalty& penalty,
                                       controller::Points& adjoint,
                                       controller::ParticleRange range);

/// Of all of them.
[[nodiscard]] PenaltyValue add_penalty(const controller::Points& locations,
                                       const Eigen::VectorXd& weights,
                                       const controller::SafeSet& safe_set,
                                       const controller::Penalty& penalty,
                                       controller::Points& adjoint);

}  // namespace qsmpc::testing
