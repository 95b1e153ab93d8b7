// The systems of a user-defined library (own_dynamics_abi.h), as Dynamics.
#pragma once

#include <memory>

#include "models/dynamics/dynamics.hpp"
#include "models/dynamics/equations/equation_system.hpp"
#include "models/dynamics/own_dynamics_abi.h"

namespace qsmpc::models {

/// The description of `system` with the defaults of its parameters, without equations. Throws
/// EquationError if it is invalid, with "states", "inputs" or "parameters" as the section.
[[nodiscard]] EquationSystem own_system_of(const qsmpc_system& system);

/// The step of `system`, with the parameters of `described` (own_system_of, values changed).
/// `owner` keeps the library in memory for as long as the result needs it. Throws
/// std::invalid_argument if the system rejects its parameters, with its own message, or if its
/// recording differs from its step. Without a recording, derivatives are finite differences and
/// their bounds are unknown.
[[nodiscard]] std::unique_ptr<const Dynamics> make_own_dynamics(const qsmpc_system& system,
                                                                const EquationSystem& described,
                                                                double time_step,
                                                                std::shared_ptr<const void> owner);

}  // namespace qsmpc::models
