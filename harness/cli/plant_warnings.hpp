// Warnings about the plants of what is going to be driven, on standard error.
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// Drives the plant of `scenario` with small inputs and prints a warning for each answer that is
/// not the model's; `whose`, unless empty, names it. Throws InputError where the plant cannot be
/// made.
void tell_plant_warnings(const Scenario& scenario, const std::string& whose = "");

/// The same for `scenario` on each of `plants`, as with_plant takes them. A plant that cannot be
/// made is left to whoever drives it.
void tell_plant_warnings(const Scenario& scenario, const std::vector<std::string>& plants);

/// The same for the variants of a campaign, once for each plant that differs, up to sixteen.
void tell_plant_warnings(const Campaign& campaign);

}  // namespace qsmpc::harness
