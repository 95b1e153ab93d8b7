// The batch scripts of a campaign on Slurm.
#pragma once

#include <string>

#include "harness/cluster/launch/launch_options.hpp"
#include "harness/cluster/launch/launcher.hpp"

namespace qsmpc::harness {

/// The script of the array, of which each task is a worker of `request`. It may be stopped and
/// requeued any time; how it ended is kept in the launch's ends_folder. Throws InputError where
/// Slurm cannot take the folder's name.
[[nodiscard]] std::string worker_script(const LaunchRequest& request, const LaunchOptions& options,
                                        const std::string& launch);

/// The script of the job after it. Throws as worker_script.
[[nodiscard]] std::string gather_script(const LaunchRequest& request, const LaunchOptions& options);

}  // namespace qsmpc::harness
