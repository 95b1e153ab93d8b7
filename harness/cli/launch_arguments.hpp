// The options of commands that start workers on other machines, beside --on, --tasks and --jobs.
#pragma once

#include <CLI/App.hpp>

#include "harness/cluster/launch/launch_options.hpp"

namespace qsmpc::harness {

/// Adds --tasks-at-once, --partition, --time, --account, --sbatch, --program and --ssh-config,
/// which set the members of `options`. Parsing throws InputError if --sbatch names a file that does
/// not exist.
void add_launch_options(CLI::App& command, LaunchOptions& options);

}  // namespace qsmpc::harness
