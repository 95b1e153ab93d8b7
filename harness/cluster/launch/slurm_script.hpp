// The batch scripts of a campaign on Slurm.
#pragma once

#include <string>

#include "harness/cluster/launch/launch_options.hpp"
#include "harness/cluster/launch/launcher.hpp"

namespace qsmpc::harness {

/// The script of the job array, whose tasks are the workers of `request`. A task may be stopped and
/// requeued at any time; its end is written to the launch's ends_folder. Throws InputError if Slurm
/// cannot handle the folder's name.
[[nodiscard]] std::string worker_script(const LaunchRequest& request, const LaunchOptions& options,
                                        const std::string& launch);

/// The script of the job after the array. Throws as worker_script.
[[nodiscard]] std::string gather_script(const LaunchRequest& request, const LaunchOptions& options);

}  // namespace qsmpc::harness
