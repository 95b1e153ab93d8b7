// User-defined systems: the examples' by equations and in C++, and one that uses every function.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "models/dynamics/dynamics.hpp"
#include "models/dynamics/equations/equation_system.hpp"

namespace qsmpc::testing {

/// The lag unicycle and the quadrotor as their scenarios in examples/ define them, named
/// "…_by_equations".
[[nodiscard]] models::EquationSystem lag_unicycle_equations();
[[nodiscard]] models::EquationSystem planar_quadrotor_equations();

/// Two states and one input, with every smooth function that formulas may call, each within its
/// domain.
[[nodiscard]] models::EquationSystem every_function_equations();

/// The systems that `make_any_dynamics` makes besides those of the table.
[[nodiscard]] const std::vector<std::string>& own_system_names();

/// A system of the table, or one of `own_system_names`, with default parameters.
[[nodiscard]] std::unique_ptr<const models::Dynamics> make_any_dynamics(const std::string& name,
                                                                        double time_step);

/// "lag_unicycle" or "planar_quadrotor" as a built-in system, a TemplatedDynamics.
[[nodiscard]] std::unique_ptr<const models::Dynamics> make_built_in(const std::string& name,
                                                                    double time_step);

}  // namespace qsmpc::testing
