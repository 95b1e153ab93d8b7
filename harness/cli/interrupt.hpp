// Ctrl-C: the first asks the running work to end and keep what is done, a second to hurry, and a
// third ends the process at once.
#pragma once

#include "harness/threads/interruption.hpp"

namespace qsmpc::harness {

/// Counts SIGINT and SIGTERM from now on (see `interrupts`); the third ends the process with exit
/// code 130. Files are whole or absent even then. To be called once.
void catch_interrupts();

}  // namespace qsmpc::harness
