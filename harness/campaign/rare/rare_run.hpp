// One run of splitting over the drives of a scenario, towards its unsafe set.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/rare/rare_row.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/splitting/splitting.hpp"

namespace qsmpc::harness {

/// Estimates how probable it is that a drive of `scenario` is unsafe at a control instant, and what
/// is certified of a drive, from random numbers that `seed` gives. The level of an instant is the
/// clearance, taken negative, so that it is above 0 exactly where the true state is unsafe.
///
/// Runs on one thread. Nothing where `should_stop`, which is asked before every period, said so.
/// Throws InputError where a drive is another one when it is driven again with the same seeds, and
/// what an EpisodeDriver throws.
[[nodiscard]] std::optional<RareRow> rare_run(const Scenario& scenario,
                                              const RareSettings& settings, std::uint64_t seed,
                                              const std::function<bool()>& should_stop);

/// `scenario` as it is driven alone so that it is the drive of `seeds`: its seed and its
/// disturbance.seeds.
[[nodiscard]] Scenario with_seeds(Scenario scenario, const PathSeeds& seeds);

}  // namespace qsmpc::harness
