// Starting a program as a process.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace qsmpc::harness {

/// Which descriptor of ours is which of the process.
struct SpawnDescriptor {
  int ours = -1;
  int theirs = -1;  ///< 0 … 9
};

/// Starts `words`, the first a path or looked for in PATH, as the leader of a process group: Ctrl-C
/// on the terminal is for this program, which decides what becomes of its processes. It has our
/// environment, no signal blocked, and the usual reactions to signals that this program catches. Of
/// our descriptors it has these and those that are not close-on-exec. Throws IoError.
[[nodiscard]] pid_t spawn_process(const std::vector<std::string>& words,
                                  const std::vector<SpawnDescriptor>& descriptors);

}  // namespace qsmpc::harness
