// Ctrl-C: the first asks the running work to end and keep what is done, a second to hurry.
#pragma once

namespace qsmpc::harness {

/// Counts SIGINT and SIGTERM from now on instead of ending the process. To be called once.
void catch_interrupts();

/// How often the process was asked to stop.
[[nodiscard]] int interrupts();

}  // namespace qsmpc::harness
