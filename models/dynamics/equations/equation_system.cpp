#include "models/dynamics/equations/equation_system.hpp"

#include <utility>

#include "models/dynamics/equations/equation_tape.hpp"
#include "models/dynamics/equations/tape_dynamics.hpp"
#include "models/dynamics/parameter_checks.hpp"

namespace qsmpc::models {

SystemDescription description_of(const EquationSystem& system) {
  return {.name = system.name,
          .summary = system.summary,
          .states = system.states,
          .inputs = system.inputs,
          .input_lower = system.input_lower,
          .input_upper = system.input_upper,
          .position_x = system.position_x,
          .position_y = system.position_y,
          .heading = system.heading};
}

void check_sizes(const EquationSystem& system) {
  const auto refuse = [](const char* section, std::string found, std::string expected) {
    throw EquationError(
        {.section = section, .found = std::move(found), .expected = std::move(expected)});
  };
  if (system.states.empty()) refuse("states", "none", "at least one");
  if (system.inputs.empty()) refuse("inputs", "none", "at least one");
  const std::size_t coordinates = system.states.size() + system.inputs.size();
  if (coordinates > kMostCoordinates) {
    refuse("states", std::to_string(coordinates) + " states and inputs",
           "at most " + std::to_string(kMostCoordinates));
  }
}

namespace {

std::string message_of(const EquationError::Where& where) {
  std::string expected = where.expected;
  for (const std::string& name : where.known) {
    expected += (expected.empty() ? "one of " : ", ") + name;
  }
  const std::string dot = where.name.empty() ? "" : ".";
  return where.section + dot + where.name + ": found " + where.found + ", expected " + expected;
}

}  // namespace

EquationError::EquationError(Where where)
    : std::invalid_argument(message_of(where)), where_(std::move(where)) {}

std::unique_ptr<const Dynamics> make_equation_dynamics(const EquationSystem& system,
                                                       double time_step) {
  check_time_step(system.name, time_step);
  check_sizes(system);
  try {
    return make_tape_dynamics(description_of(system), step_tape(system, time_step));
  } catch (const std::length_error& error) {
    throw EquationError({.section = "equations",
                         .found = error.what(),
                         .expected = "fewer substeps or shorter formulas"});
  }
}

}  // namespace qsmpc::models
