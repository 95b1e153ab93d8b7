// Warnings about plants that are about to be driven, on standard error.
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// Drives the plant of `scenario` with small inputs and prints a warning for each response that
/// differs from the model's; `whose`, unless empty, names it. Throws InputError if the plant cannot
/// be created.
void tell_plant_warnings(const Scenario& scenario, const std::string& whose = "");

/// The same for `scenario` on each of `plants`, as with_plant takes them. A plant that cannot be
/// created is skipped; driving it will report the error.
void tell_plant_warnings(const Scenario& scenario, const std::vector<std::string>& plants);

/// The same for the variants of a campaign, once for each distinct plant, up to sixteen.
void tell_plant_warnings(const Campaign& campaign);

}  // namespace qsmpc::harness
