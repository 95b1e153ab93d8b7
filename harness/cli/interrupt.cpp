#include "harness/cli/interrupt.hpp"

#include <csignal>

#include <unistd.h>

#include "harness/cli/exit_codes.hpp"

namespace qsmpc::harness {
namespace {

// The first lets work end, the second hurries it; who asks once more shall not wait.
constexpr int kEndsAtOnce = 3;

extern "C" void count_signal(int /*number*/) {
  if (note_interrupt() >= kEndsAtOnce) _exit(kInterruptedExit);
}

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = count_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;  // no write of a result is cut short by it
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A reader that went away is an error of the write, not a death of the process.
  std::signal(SIGPIPE, SIG_IGN);
}

}  // namespace qsmpc::harness
