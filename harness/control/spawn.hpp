// Starts programs as processes.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace qsmpc::harness {

/// Maps one of our descriptors to one of the process.
struct SpawnDescriptor {
  int ours = -1;
  int theirs = -1;  ///< 0 … 9
};

/// Starts `words`, the first being a path or a name in PATH, as the leader of a process group, so
/// that Ctrl-C on the terminal reaches only this program, which decides about its processes. The
/// process has our environment, no blocked signals, and the default handlers for signals that this
/// program catches. Of our descriptors it inherits these and those that are not close-on-exec.
/// Throws IoError.
[[nodiscard]] pid_t spawn_process(const std::vector<std::string>& words,
                                  const std::vector<SpawnDescriptor>& descriptors);

}  // namespace qsmpc::harness
