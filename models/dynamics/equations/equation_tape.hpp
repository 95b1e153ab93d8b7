// Turns a system of equations into the tape of its step.
#pragma once

#include "models/dynamics/equations/equation_system.hpp"
#include "models/dynamics/equations/tape.hpp"

namespace qsmpc::models {

/// The step of `system`, as a function of the states, then the inputs. Throws as
/// make_equation_dynamics does.
[[nodiscard]] Tape step_tape(const EquationSystem& system, double time_step);

}  // namespace qsmpc::models
