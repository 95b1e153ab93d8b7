// The tasks of a campaign started, on this machine or others, and what they are to begin with.
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

/// Gives `folder`, which is there, the plan of `campaign`, unless it has one. lease_seeds: of a new
/// plan; 0: by default_lease_seeds with `at_once` episodes at the same time.
///
/// Throws InputError where the plan that it has is another campaign's, or has leases of another
/// size than is asked for, and where the folder is that of a campaign without tasks; IoError.
void plan_tasks(const Campaign& campaign, const std::string& folder, std::int64_t lease_seeds,
                std::int64_t at_once);

/// Tasks that were started.
struct StartedTasks {
  std::unique_ptr<Launcher> launcher;
  TaskLaunch launch;
};

/// Starts tasks for the campaign in `folder`, which has a plan, as `request` says: of its `launch`
/// and `record` nothing is used. `program`: this one's path.
///
/// Throws InputError where the launcher's options are wrong, IoError where tasks that were started
/// before are still at work, or none can be started.
[[nodiscard]] StartedTasks start_tasks(const std::string& folder, TaskLaunch request,
                                       const std::string& program);

/// Has the tasks that were started last ended, without waiting for it. Throws InputError where none
/// were, IoError.
void cancel_tasks(const std::string& folder);

}  // namespace qsmpc::harness
