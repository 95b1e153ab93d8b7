// Numbers of points that a scenario leaves to the program to choose.
#pragma once

#include <optional>

#include "controller/planning/points_choice.hpp"
#include "harness/scenario/scenario.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// If `controller.quantisation` has a tolerance, replaces it by the numbers of points that it
/// requires, chosen by controller::choose_points from the initial belief on, with obstacles at
/// their initial positions. If the controller does not plan by quantisation, the scenario's numbers
/// are kept. Returns the choice, if one was made. Throws std::invalid_argument on inconsistent
/// settings.
std::optional<controller::PointsChoice> choose_points(Scenario& scenario);

/// The same on a copy.
[[nodiscard]] Scenario with_chosen_points(Scenario scenario);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
