#include "harness/cli/interrupt.hpp"

#include <csignal>

namespace qsmpc::harness {
namespace {

volatile std::sig_atomic_t signals_seen = 0;

extern "C" void count_signal(int /*number*/) { signals_seen = signals_seen + 1; }

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

int interrupts() { return signals_seen; }

}  // namespace qsmpc::harness
