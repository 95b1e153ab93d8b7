// Folders that hold a result already: one of another scenario is not replaced without a word.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// `--force`: replace what the output folder holds.
void add_force_option(CLI::App& command, bool& force);

/// Throws InputError where `folder` holds a scenario.yaml that leads to other results than
/// `scenario` does, as resolved and with its seed, or a campaign. What a scenario is called leads
/// to no other results. `force`: nothing is refused.
void refuse_other_result(const std::string& folder, const Scenario& scenario, bool force);

/// The first key in which two resolved scenarios differ and what they say there, e.g.
/// "controller.horizon is 8 there, 10 here, and 2 more keys differ"; empty where they differ in no
/// key but their name and description. `there`, `here`: YAML.
[[nodiscard]] std::string scenario_difference(const std::string& there, const std::string& here);

}  // namespace qsmpc::harness
