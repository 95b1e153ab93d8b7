// Starts the tasks of a campaign, on this machine or others, and prepares their folder.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "harness/campaign/campaign.hpp"
#include "harness/cluster/launch/launcher.hpp"
#include "harness/cluster/launch_file.hpp"
#include "harness/cluster/lease_plan.hpp"

namespace qsmpc::harness {

/// Writes the plan of `campaign` to the existing folder `folder`, unless it has one. lease_seeds:
/// seeds per lease of a new plan; 0: by default_lease_seeds for `at_once` concurrent episodes.
///
/// Throws InputError if the existing plan is of another campaign or of another lease size than
/// requested, or if the folder is that of a campaign without tasks; IoError.
void plan_tasks(const Campaign& campaign, const std::string& folder, std::int64_t lease_seeds,
                std::int64_t at_once);

/// The tasks started.
struct StartedTasks {
  std::unique_ptr<Launcher> launcher;
  TaskLaunch launch;
};

/// Starts tasks for the campaign in `folder`, which has a plan, according to `request`, whose
/// members `launch` and `record` are ignored. `program`: the path of this program.
///
/// Throws InputError if the launcher's options are invalid, IoError if tasks started before are
/// still at work, or if none can be started.
[[nodiscard]] StartedTasks start_tasks(const std::string& folder, TaskLaunch request,
                                       const std::string& program);

/// Requests the end of the tasks of the last launch, without waiting for it. Throws InputError if
/// there was none, IoError.
void cancel_tasks(const std::string& folder);

}  // namespace qsmpc::harness
