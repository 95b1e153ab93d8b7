// The planner's own model as a plant: x⁺ = f(x, u) + w.
#pragma once

#include <memory>

#include "harness/plant/plant.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// dynamics: not null. control_period: s, the period that the dynamics was made for. `advance`
/// returns one motion sample, at the end of the period and without qpos. A state that is not finite
/// is a fault: the state remains the last good one, and every later step returns the same fault
/// until `reset`. Vectors of the wrong size, and a state for `reset` that is not finite, throw
/// std::invalid_argument.
[[nodiscard]] std::unique_ptr<Plant> make_analytic_plant(
    std::unique_ptr<const models::Dynamics> dynamics, double control_period);

}  // namespace qsmpc::harness
