// The arguments that name a scenario, the same for every command.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace qsmpc::harness {

/// SCENARIO, which is required.
void add_scenario_argument(CLI::App& command, std::string& scenario);

/// --set KEY=VALUE, as often as wanted.
void add_set_option(CLI::App& command, std::vector<std::string>& overrides);

}  // namespace qsmpc::harness
