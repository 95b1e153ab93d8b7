// The systems of a library of one's own (own_dynamics_abi.h), as Dynamics.
#pragma once

#include <memory>

#include "models/dynamics/dynamics.hpp"
#include "models/dynamics/equations/equation_system.hpp"
#include "models/dynamics/own_dynamics_abi.h"

namespace qsmpc::models {

/// What `system` says of itself, with its parameters' defaults; no equations. Throws
/// EquationError where that cannot be, with "states", "inputs" or "parameters" as section.
[[nodiscard]] EquationSystem own_system_of(const qsmpc_system& system);

/// The step of `system`, with the parameters of `described` (own_system_of, values changed).
/// `owner` keeps the library in memory for as long as the result needs it. Throws
/// std::invalid_argument with the system's own words where it refuses its parameters, or where what
/// it records is not its step. Without a recording derivatives are finite differences, and nothing
/// is known of their bounds.
[[nodiscard]] std::unique_ptr<const Dynamics> make_own_dynamics(const qsmpc_system& system,
                                                                const EquationSystem& described,
                                                                double time_step,
                                                                std::shared_ptr<const void> owner);

}  // namespace qsmpc::models
