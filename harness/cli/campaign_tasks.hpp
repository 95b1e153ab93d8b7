// Campaigns that tasks drive, on this machine or others: started, waited for, and gathered.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/cli/fail_on.hpp"
#include "harness/cluster/launch_file.hpp"

namespace qsmpc::harness {

/// How a command says what it does and what came of it.
struct TasksTalk {
  bool quiet = false;
  bool json = false;
  std::vector<std::string> fail_on = {"fault"};
};

/// Starts tasks for the campaign in `folder`, which has a plan, as `request` says. Where they are
/// machines' own matter, says how to ask about them and returns kDone; else waits until they have
/// ended and gathers what they did, as `gather_and_tell`. Ctrl-C lets them end the episodes that
/// they have begun; a second one gives these up. Throws IoError where another process has the
/// folder; as start_tasks and gather_and_tell do.
[[nodiscard]] int drive_with_tasks(const std::string& folder, const TaskLaunch& request,
                                   const TasksTalk& talk);

/// Gathers what the tasks in `folder` have driven and writes and prints the campaign's results.
/// Returns kDone; kToldFailure for what --fail-on names; kInterruptedExit where episodes are
/// missing, and says how many. Throws as gather_tasks and write_campaign_results do.
[[nodiscard]] int gather_and_tell(const std::string& folder, const TasksTalk& talk,
                                  bool tasks_have_ended);

/// Throws InputError where tasks drive the campaign in `folder` and have not finished.
void refuse_unfinished_tasks(const std::string& folder);

}  // namespace qsmpc::harness
