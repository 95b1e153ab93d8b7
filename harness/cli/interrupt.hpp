// Ctrl-C: the first asks the running work to stop and keep its results, the second to hurry, and
// the third ends the process at once.
#pragma once

#include "harness/threads/interruption.hpp"

namespace qsmpc::harness {

/// Counts SIGINT and SIGTERM from now on (see `interrupts`); the third ends the process with exit
/// code 130. Even then, files are complete or absent. To be called once.
void catch_interrupts();

}  // namespace qsmpc::harness
