// What Slurm says of a job array.
#pragma once

#include <string>
#include <vector>

#include "harness/cluster/launch/launcher.hpp"

namespace qsmpc::harness {

/// What `slurm_tasks` reads: squeue's option --Format.
inline constexpr const char* kSqueueFormat =
    "ArrayTaskID:|,State:|,NodeList:|,Reason:|,RestartCnt:|";

/// The tasks in squeue's answer, in its order. Slurm's word for the state and what is remarkable
/// about it are the note. Throws IoError where it is in another form.
[[nodiscard]] std::vector<TaskState> slurm_tasks(const std::string& answer);

}  // namespace qsmpc::harness
