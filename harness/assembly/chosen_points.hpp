// Numbers of points that a scenario leaves to the program.
#pragma once

#include <optional>

#include "controller/planning/points_choice.hpp"
#include "harness/scenario/scenario.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// Where `controller.quantisation` has a tolerance: puts the numbers that it asks for in its place,
/// found by controller::choose_points from the initial belief on, among obstacles that stand where
/// they are at the beginning. They are those that the scenario has where its controller does not
/// plan by quantisation. Returns what was found, if anything was looked for. Throws
/// std::invalid_argument on settings that make no sense.
std::optional<controller::PointsChoice> choose_points(Scenario& scenario);

/// The same as a new value.
[[nodiscard]] Scenario with_chosen_points(Scenario scenario);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
