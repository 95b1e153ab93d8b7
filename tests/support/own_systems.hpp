// Systems of a user's: the examples' by equations and in C++, and one of every function.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "models/dynamics/dynamics.hpp"
#include "models/dynamics/equations/equation_system.hpp"

namespace qsmpc::testing {

/// The lag unicycle and the quadrotor as their scenarios in examples/ say them, with the names
/// "…_by_equations".
[[nodiscard]] models::EquationSystem lag_unicycle_equations();
[[nodiscard]] models::EquationSystem planar_quadrotor_equations();

/// Two states and an input, and every smooth function that formulas may call, each within its
/// domain.
[[nodiscard]] models::EquationSystem every_function_equations();

/// Those that `make_any_dynamics` makes besides the table's.
[[nodiscard]] const std::vector<std::string>& own_system_names();

/// A system of the table, or one of `own_system_names`, with default parameters.
[[nodiscard]] std::unique_ptr<const models::Dynamics> make_any_dynamics(const std::string& name,
                                                                        double time_step);

/// "lag_unicycle" or "planar_quadrotor" as a system of the program's own, a TemplatedDynamics.
[[nodiscard]] std::unique_ptr<const models::Dynamics> make_built_in(const std::string& name,
                                                                    double time_step);

}  // namespace qsmpc::testing
