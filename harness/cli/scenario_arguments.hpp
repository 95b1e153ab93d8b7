// The arguments that name a scenario, the same for every command.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace qsmpc::harness {

/// SCENARIO, which is required.
void add_scenario_argument(CLI::App& command, std::string& scenario);

/// --set KEY=VALUE, as often as wanted.
void add_set_option(CLI::App& command, std::vector<std::string>& overrides);

/// `--seed N`: `words` say of what.
void add_seed_option(CLI::App& command, std::optional<std::uint64_t>& seed,
                     const std::string& words);

}  // namespace qsmpc::harness
