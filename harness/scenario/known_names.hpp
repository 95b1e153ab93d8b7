// The names that a scenario may use for things that are chosen by name, and what to suggest for one
// that is not known.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "harness/scenario/scenario.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Names of states or inputs.
[[nodiscard]] std::vector<std::string> coordinate_names(
    const std::vector<models::Coordinate>& coordinates);

[[nodiscard]] const std::vector<std::string>& system_names();
[[nodiscard]] const std::vector<std::string>& controller_names();
/// Controllers that a shield may be about: those of the program but itself.
[[nodiscard]] const std::vector<std::string>& shielded_names();
[[nodiscard]] const std::vector<std::string>& estimator_names();
/// The kind of the controller that chooses the inputs: of a shield the one that it is about.
[[nodiscard]] const std::string& driving_kind(const Scenario::Controller& controller);
/// Whether that draws input sequences: "mppi" or "risk_mppi".
[[nodiscard]] bool is_sampling(const Scenario::Controller& controller);

/// About what "lqr" linearises.
[[nodiscard]] const std::vector<std::string>& lqr_about_names();
/// What is done where a limit of the risk can't be kept.
[[nodiscard]] const std::vector<std::string>& risk_otherwise_names();
[[nodiscard]] const std::vector<std::string>& solver_names();
[[nodiscard]] const std::vector<std::string>& input_bounding_names();
/// Those that propagate noise; `propagate_noise: false` stands for the other, "noise_free".
[[nodiscard]] const std::vector<std::string>& propagator_names();
[[nodiscard]] const std::vector<std::string>& quantiser_names();
[[nodiscard]] const std::vector<std::string>& policy_names();
/// What plans aim along.
[[nodiscard]] const std::vector<std::string>& guide_names();
[[nodiscard]] const std::vector<std::string>& penalty_shape_names();
[[nodiscard]] const std::vector<std::string>& plant_kind_names();
[[nodiscard]] const std::vector<std::string>& disturbance_kind_names();
[[nodiscard]] const std::vector<std::string>& camera_names();
/// What may be drawn over the scene of a video.
[[nodiscard]] const std::vector<std::string>& overlay_names();

/// Least number of bytes to insert, delete, replace, or swap with a neighbour, that makes `a` into
/// `b` (optimal string alignment distance).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// Up to three of `known` that `name` may have been meant to be, the nearest first; empty if none
/// is near.
[[nodiscard]] std::vector<std::string> nearest_names(std::string_view name,
                                                     const std::vector<std::string>& known);

/// What an error says is expected in place of the unknown `name`: "lbfgs (known: lbfgs, slsqp)"
/// when one is near, otherwise "one of lbfgs, slsqp".
[[nodiscard]] std::string expected_names(std::string_view name,
                                         const std::vector<std::string>& known);

}  // namespace qsmpc::harness
