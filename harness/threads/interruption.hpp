// Interruption by SIGINT or SIGTERM, in a form that long computations can poll.
//
//   for (long k = 0; k < steps; ++k) {
//     check_interrupts();
//     step();
//   }
#pragma once

#include <exception>

namespace qsmpc::harness {

/// Work was abandoned because the process was asked to stop. Exit code 130.
class Interrupted : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }
};

/// How often the process was asked to stop.
[[nodiscard]] int interrupts() noexcept;

/// Records a request to stop and returns the number of requests so far. For signal handlers.
int note_interrupt() noexcept;

/// Resets the number of requests, for programs that continue after an interrupt.
void forget_interrupts() noexcept;

/// Throws Interrupted if the process was asked to stop: once, or as often as an InterruptPatience
/// requires. Costs next to nothing; may be called by several threads.
void check_interrupts();

/// While it lives, only the `count`-th interrupt (≥ 1) ends work; e.g. the first interrupt lets the
/// running episodes of a campaign finish.
class InterruptPatience {
 public:
  explicit InterruptPatience(int count);
  ~InterruptPatience();
  InterruptPatience(const InterruptPatience&) = delete;
  InterruptPatience& operator=(const InterruptPatience&) = delete;

 private:
  int before_;
};

}  // namespace qsmpc::harness
