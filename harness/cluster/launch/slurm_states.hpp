// Parses Slurm's description of a job array.
#pragma once

#include <string>
#include <vector>

#include "harness/cluster/launch/launcher.hpp"

namespace qsmpc::harness {

/// squeue's option --Format for the output that `slurm_tasks` parses.
inline constexpr const char* kSqueueFormat =
    "ArrayTaskID:|,State:|,NodeList:|,Reason:|,RestartCnt:|";

/// The tasks in squeue's output, in its order. The note holds Slurm's state name with the reason
/// and restarts, if any. Throws IoError if the output has another format.
[[nodiscard]] std::vector<TaskState> slurm_tasks(const std::string& answer);

}  // namespace qsmpc::harness
