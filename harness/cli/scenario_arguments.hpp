// The arguments that specify a scenario, common to all commands.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// Adds SCENARIO, which is required.
void add_scenario_argument(CLI::App& command, std::string& scenario);

/// Adds --set KEY=VALUE, which may be repeated.
void add_set_option(CLI::App& command, std::vector<std::string>& overrides);

/// Adds `--seed N`; `words` describe what the seed is for.
void add_seed_option(CLI::App& command, std::optional<std::uint64_t>& seed,
                     const std::string& words);

/// Throws InputError if `count` simultaneous drives of `scenario` need more memory than the
/// documented share. `path_or_name` and `overrides` are what the scenario was loaded from.
void refuse_beyond_memory(const Scenario& scenario, const std::string& path_or_name,
                          const std::vector<std::string>& overrides, int count = 1);

/// Throws InputError if an obstacle of `scenario` moves, which `command` does not support.
void refuse_motion(const Scenario& scenario, const std::string& path_or_name,
                   const std::vector<std::string>& overrides, const std::string& command);

/// Chooses the points of a scenario that leaves the choice to the program, and says so on standard
/// error unless `quiet`.
void settle_points(Scenario& scenario, bool quiet);

}  // namespace qsmpc::harness
