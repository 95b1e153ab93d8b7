// The Slurm cluster that slurm_here has started around the tests.
#pragma once

#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "harness/cluster/launch/command.hpp"

namespace qsmpc::testing {

/// The output of one of Slurm's commands. Throws if it fails, and outside slurm_here.
inline std::string slurm_command(const std::vector<std::string>& words) {
  if (std::getenv("SLURM_CONF") == nullptr) {
    throw std::runtime_error("to be run by tests/cluster/slurm_here");
  }
  return harness::command_output(words);
}

/// Kills slurmd of the node `name` and everything running there.
inline void kill_node(const std::string& name) {
  slurm_command({QSMPC_SOURCE_DIR "/tests/cluster/slurm_here", "--kill", name});
}

/// Starts it again and waits until Slurm reports the node.
inline void start_node(const std::string& name) {
  slurm_command({QSMPC_SOURCE_DIR "/tests/cluster/slurm_here", "--start", name});
}

}  // namespace qsmpc::testing
