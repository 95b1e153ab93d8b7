// The arguments that name a scenario, the same for every command.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// SCENARIO, which is required.
void add_scenario_argument(CLI::App& command, std::string& scenario);

/// --set KEY=VALUE, as often as wanted.
void add_set_option(CLI::App& command, std::vector<std::string>& overrides);

/// `--seed N`: `words` say of what.
void add_seed_option(CLI::App& command, std::optional<std::uint64_t>& seed,
                     const std::string& words);

/// Throws InputError where `count` drives of `scenario` at the same time need more memory than the
/// documented share; `path_or_name` and `overrides` are what the scenario was loaded from.
void refuse_beyond_memory(const Scenario& scenario, const std::string& path_or_name,
                          const std::vector<std::string>& overrides, int count = 1);

/// Throws InputError where an obstacle of `scenario` moves, of which `command` knows nothing.
void refuse_motion(const Scenario& scenario, const std::string& path_or_name,
                   const std::vector<std::string>& overrides, const std::string& command);

/// Chooses the points of a scenario that leaves them to the program, and says so on standard error
/// unless `quiet`.
void settle_points(Scenario& scenario, bool quiet);

}  // namespace qsmpc::harness
