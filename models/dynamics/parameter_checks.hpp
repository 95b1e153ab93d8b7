// Checks of parameters, shared by the systems.
#pragma once

#include <string_view>

#include "models/dynamics/dynamics.hpp"

namespace qsmpc::models {

/// Throws std::invalid_argument unless time_step (s) is finite and above 0.
void check_time_step(std::string_view system, double time_step);

/// The parameter called `name`. Throws std::invalid_argument unless it is finite and above 0.
[[nodiscard]] double positive_parameter(std::string_view system, const ParameterMap& parameters,
                                        std::string_view name);

/// The same for parameters that may be 0.
[[nodiscard]] double non_negative_parameter(std::string_view system, const ParameterMap& parameters,
                                            std::string_view name);

/// The same for parameters below 0.
[[nodiscard]] double negative_parameter(std::string_view system, const ParameterMap& parameters,
                                        std::string_view name);

}  // namespace qsmpc::models
