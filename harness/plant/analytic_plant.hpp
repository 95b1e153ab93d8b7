// The planner's own model as plant: x⁺ = f(x, u) + w.
#pragma once

#include <memory>

#include "harness/plant/plant.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// dynamics: not null. control_period: s, the one that the dynamics was made for.
/// `advance` brings one motion sample, at the period's end and without qpos. A state that is not
/// finite is a fault: the state stays the last good one, and every later step brings the same fault
/// until `reset`. Vectors of a wrong size, and a state for `reset` that is not finite, throw
/// std::invalid_argument.
[[nodiscard]] std::unique_ptr<Plant> make_analytic_plant(
    std::unique_ptr<const models::Dynamics> dynamics, double control_period);

}  // namespace qsmpc::harness
