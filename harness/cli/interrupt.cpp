#include "harness/cli/interrupt.hpp"

#include <csignal>

#include <unistd.h>

#include "harness/cli/exit_codes.hpp"

namespace qsmpc::harness {
namespace {

// The first interrupt lets work finish, the second hurries it, the third does not wait.
constexpr int kEndsAtOnce = 3;

extern "C" void count_signal(int /*number*/) {
  if (note_interrupt() >= kEndsAtOnce) _exit(kInterruptedExit);
}

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = count_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;  // interrupts do not cut writes short
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A closed pipe becomes a write error instead of killing the process.
  std::signal(SIGPIPE, SIG_IGN);
}

}  // namespace qsmpc::harness
