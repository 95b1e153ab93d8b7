// The planner's model of a scenario, whether built in or user-defined.
#pragma once

#include <memory>

#include "harness/scenario/scenario.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// The model for the control period `time_step` (s). Throws InputError where a library cannot be
/// loaded, and std::invalid_argument where the system rejects its parameters.
[[nodiscard]] std::unique_ptr<const models::Dynamics> make_model(const Scenario::Model& model,
                                                                 double time_step);

/// The names, units and bounds of the scenario's system. Does not load a library.
[[nodiscard]] models::SystemDescription system_of(const Scenario& scenario);

}  // namespace qsmpc::harness
