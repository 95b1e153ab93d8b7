// Loads and checks campaign files; errors say where and why. docs/campaign.md describes their keys.
//
//   const Campaign campaign = load_campaign("dubins_thousand");
//   std::cout << campaign_plan_text(campaign);
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/errors.hpp"

namespace qsmpc::harness {

/// The path of the campaign `path_or_name`: a path, or the name of a shipped one. Throws InputError
/// when it is neither.
[[nodiscard]] std::string find_campaign(const std::string& path_or_name);

/// Loads a campaign file, given by its path or the name of a shipped one. Every variant is loaded
/// and checked, and every plant is constructed once. Throws InputError with the first problem: its
/// file (the campaign's, or a scenario's), line, key, what was found and what is expected.
[[nodiscard]] Campaign load_campaign(const std::string& path_or_name);

/// All problems of a campaign file and the scenarios that it names; empty if all are valid. At most
/// 100; if the file cannot be parsed, only that problem.
[[nodiscard]] std::vector<InputError::Where> validate_campaign_file(
    const std::string& path_or_name);

/// Whether `path_or_name` is a campaign, valid or not, rather than a scenario: a mapping with one
/// of scenario, scenarios, variants, grid and seeds, and without model; or the name of a shipped
/// campaign. False if it cannot be read.
[[nodiscard]] bool is_campaign_file(const std::string& path_or_name);

}  // namespace qsmpc::harness
