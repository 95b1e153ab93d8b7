// How a drive ends: whether it reached its target, and where its true state first was unsafe.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/unsafe_part.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::harness {

/// Earlier versions' name for the outcome of a drive whose true state was unsafe.
inline constexpr const char* kLeftSafeSet = "left_safe_set";

/// Whether `state` (state_dim) is within the target's radius: in the plane of position if the
/// system has one, otherwise in the norm of all states. On a closed path instead: whether all laps
/// are complete at arc length `progress`. On an open path in addition: whether its end is within
/// the radius of arc length `progress`. With waypoints, of which `progress` have been passed, in
/// addition: whether only the last one remains.
[[nodiscard]] bool at_target(const Scenario& scenario, const models::SystemDescription& system,
                             const Eigen::VectorXd& state, std::optional<double> progress = {});

/// Whether the drive ended at its target, whatever happened on the way. False for a drive that
/// ended in a fault or was interrupted.
[[nodiscard]] bool ended_at_target(const Trace& trace);

/// kCollision or kLeftBounds: the outcome of a drive whose first unsafe state is in `part`; nothing
/// for kNone.
[[nodiscard]] std::optional<Outcome> outcome_in(controller::UnsafePart part);

/// The outcome implied by the first unsafe true state at a control instant of `trace`; nothing if
/// all of them are safe.
[[nodiscard]] std::optional<Outcome> first_unsafe_outcome(const Trace& trace);

/// The number of drives by outcome, in the order of outcome_names; other names, from earlier
/// versions, come last.
[[nodiscard]] std::vector<std::pair<std::string, std::int64_t>> in_order(
    const std::map<std::string, std::int64_t>& outcomes);

}  // namespace qsmpc::harness
