// The header of a drive's trace, before its first period.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/scenario/scenario.hpp"
#include "harness/trace/trace.hpp"
#include "models/dynamics/dynamics.hpp"
#include "models/random/noise_seeds.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// The header of the trace of `scenario`: the scenario, its text, its system, seed, version, and
/// the vehicle's digest. Numbers of points that the scenario leaves to the program are chosen here.
/// Throws std::invalid_argument as choose_points.
[[nodiscard]] Trace trace_header(const Scenario& scenario, std::uint64_t seed);

/// The same without the digest, for a scenario whose points are chosen and whose system is known,
/// with the noise seeds that are used.
[[nodiscard]] Trace trace_header(const Scenario& scenario, const models::SystemDescription& system,
                                 std::uint64_t seed, const std::vector<models::NoiseSeed>& noise);

/// plant_digest; empty if the vehicle is not available.
[[nodiscard]] std::string digest_if_there(const Scenario& scenario);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
