// The names that a scenario may use, and suggestions for unknown names.
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
/// Controllers that may be shielded: the program's own, except the shield itself.
[[nodiscard]] const std::vector<std::string>& shielded_names();
[[nodiscard]] const std::vector<std::string>& estimator_names();
/// The kind of the controller that chooses the inputs: for a shield, that of the shielded one.
[[nodiscard]] const std::string& driving_kind(const Scenario::Controller& controller);
/// Whether the driving controller samples input sequences: "mppi" or "risk_mppi".
[[nodiscard]] bool is_sampling(const Scenario::Controller& controller);

/// The linearisation points of "lqr".
[[nodiscard]] const std::vector<std::string>& lqr_about_names();
/// The fallbacks where a risk limit cannot be kept.
[[nodiscard]] const std::vector<std::string>& risk_otherwise_names();
[[nodiscard]] const std::vector<std::string>& solver_names();
[[nodiscard]] const std::vector<std::string>& input_bounding_names();
/// Propagators that propagate noise; `propagate_noise: false` selects the remaining one,
/// "noise_free".
[[nodiscard]] const std::vector<std::string>& propagator_names();
[[nodiscard]] const std::vector<std::string>& quantiser_names();
[[nodiscard]] const std::vector<std::string>& policy_names();
/// The guides of plans.
[[nodiscard]] const std::vector<std::string>& guide_names();
[[nodiscard]] const std::vector<std::string>& penalty_shape_names();
[[nodiscard]] const std::vector<std::string>& plant_kind_names();
[[nodiscard]] const std::vector<std::string>& disturbance_kind_names();
[[nodiscard]] const std::vector<std::string>& camera_names();
/// The overlays of a video.
[[nodiscard]] const std::vector<std::string>& overlay_names();

/// Least number of bytes to insert, delete, replace or swap with a neighbour to turn `a` into `b`
/// (optimal string alignment distance).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// Up to three of `known` that `name` may be a misspelling of, nearest first; empty if none is
/// near.
[[nodiscard]] std::vector<std::string> nearest_names(std::string_view name,
                                                     const std::vector<std::string>& known);

/// The expectation that an error states for the unknown `name`: "lbfgs (known: lbfgs, slsqp)" if a
/// known name is near, otherwise "one of lbfgs, slsqp".
[[nodiscard]] std::string expected_names(std::string_view name,
                                         const std::vector<std::string>& known);

}  // namespace qsmpc::harness
