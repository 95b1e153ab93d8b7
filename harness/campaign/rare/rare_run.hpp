// One splitting run over the drives of a scenario, towards its unsafe set.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/rare/rare_row.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/splitting/splitting.hpp"

namespace qsmpc::harness {

/// Estimates the probability that a drive of `scenario` is unsafe at a control instant, and the
/// mean sum of a drive's certificates, with random numbers from `seed`. The level of an instant is
/// the negative clearance, made such that it is above 0 exactly where the true state is unsafe.
///
/// Runs on one thread. Returns nothing if `should_stop`, which is called before every period,
/// returned true. Throws InputError if a drive is not reproducible from its seeds, and whatever an
/// EpisodeDriver throws.
[[nodiscard]] std::optional<RareRow> rare_run(const Scenario& scenario,
                                              const RareSettings& settings, std::uint64_t seed,
                                              const std::function<bool()>& should_stop);

/// `scenario` with the seed and disturbance.seeds that reproduce the drive of `seeds`.
[[nodiscard]] Scenario with_seeds(Scenario scenario, const PathSeeds& seeds);

}  // namespace qsmpc::harness
