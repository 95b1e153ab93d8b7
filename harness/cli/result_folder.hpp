// Folders that already hold a result: that of another scenario is not silently replaced.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// Adds `--force`: replace what the output folder holds.
void add_force_option(CLI::App& command, bool& force);

/// Throws InputError if `folder` holds a campaign, or a scenario.yaml that leads to results other
/// than those of `scenario`, as resolved and with its seed. A scenario's name does not affect its
/// results. `force`: nothing is refused.
void refuse_other_result(const std::string& folder, const Scenario& scenario, bool force);

/// The first key in which two resolved scenarios differ and its values, e.g. "controller.horizon is
/// 8 there, 10 here, and 2 more keys differ"; empty if they differ at most in name and description.
/// `there`, `here`: YAML.
[[nodiscard]] std::string scenario_difference(const std::string& there, const std::string& here);

}  // namespace qsmpc::harness
