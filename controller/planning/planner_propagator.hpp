// The propagator that a planner's settings ask for.
#pragma once

#include <memory>

#include "controller/planning/planner_settings.hpp"
#include "controller/prediction/propagator.hpp"

namespace qsmpc::controller {

/// Throws std::invalid_argument as make_propagator does.
[[nodiscard]] inline std::unique_ptr<Propagator> planner_propagator(
    const PlannerSettings& settings) {
  return make_propagator(settings.propagator,
                         {.noise = {.mean = Eigen::VectorXd::Zero(settings.noise_covariance.rows()),
                                    .covariance = settings.noise_covariance},
                          .noise_points = settings.noise_points,
                          .compressed_points = settings.compressed_points});
}

}  // namespace qsmpc::controller
