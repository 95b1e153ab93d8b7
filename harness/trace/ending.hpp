// How a drive ends: at its target, and where its true state first was unsafe.
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

/// What earlier versions called the end of a drive whose true state was unsafe.
inline constexpr const char* kLeftSafeSet = "left_safe_set";

/// Whether `state` (state_dim) is within the target's radius: in the plane of position where the
/// system has one, else in the norm of all states. On a path, at arc length `progress`: whether all
/// laps are done, or the end of an open path is within the radius. Of waypoints, `progress` of
/// which have been passed: whether it is the last.
[[nodiscard]] bool at_target(const Scenario& scenario, const models::SystemDescription& system,
                             const Eigen::VectorXd& state, std::optional<double> progress = {});

/// Whether the drive ended at its target, whatever happened on the way; not one that broke or was
/// interrupted.
[[nodiscard]] bool ended_at_target(const Trace& trace);

/// kCollision or kLeftBounds: the outcome of a drive whose first unsafe state is in this part; none
/// for kNone.
[[nodiscard]] std::optional<Outcome> outcome_in(controller::UnsafePart part);

/// The same of the first true state at a control instant of `trace` that is unsafe; none if all of
/// them are safe.
[[nodiscard]] std::optional<Outcome> first_unsafe_outcome(const Trace& trace);

/// How many drives ended how, in the order of outcome_names; other words, those of earlier
/// versions, come last.
[[nodiscard]] std::vector<std::pair<std::string, std::int64_t>> in_order(
    const std::map<std::string, std::int64_t>& outcomes);

}  // namespace qsmpc::harness
