// Campaigns driven by tasks on this machine or others: starting, waiting and gathering.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/cli/fail_on.hpp"
#include "harness/cluster/launch_file.hpp"

namespace qsmpc::harness {

/// How a command reports its progress and results.
struct TasksTalk {
  bool quiet = false;
  bool json = false;
  std::vector<std::string> fail_on = {"fault"};
};

/// Starts tasks for the campaign in `folder`, which has a plan, as specified by `request`. If a
/// batch system runs them (see Launcher::stays), prints how to query them and returns kDone.
/// Otherwise waits until they have ended and gathers their results as `gather_and_tell`. Ctrl-C
/// lets them finish running episodes; a second one abandons these. Throws IoError if another
/// process holds the folder, and as start_tasks and gather_and_tell do.
[[nodiscard]] int drive_with_tasks(const std::string& folder, const TaskLaunch& request,
                                   const TasksTalk& talk);

/// Gathers the episodes driven by the tasks in `folder`, and writes and prints the campaign's
/// results. Returns kDone; kToldFailure if something that --fail-on names occurred; or
/// kInterruptedExit if episodes are missing, and reports how many. Throws as gather_tasks and
/// write_campaign_results do.
[[nodiscard]] int gather_and_tell(const std::string& folder, const TasksTalk& talk,
                                  bool tasks_have_ended);

/// Throws InputError if tasks drive the campaign in `folder` and have not finished.
void refuse_unfinished_tasks(const std::string& folder);

}  // namespace qsmpc::harness
