// Being asked to stop, by SIGINT or SIGTERM, where long stretches of work can hear it.
//
//   for (long k = 0; k < steps; ++k) {
//     check_interrupts();
//     step();
//   }
#pragma once

#include <exception>

namespace qsmpc::harness {

/// Work was given up because the process was asked to stop. Exit code 130.
class Interrupted : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }
};

/// How often the process was asked to stop.
[[nodiscard]] int interrupts() noexcept;

/// Notes that the process was asked to stop, and returns how often it was. For signal handlers.
int note_interrupt() noexcept;

/// As if the process had not been asked yet, for programs that go on after an interrupt.
void forget_interrupts() noexcept;

/// Throws Interrupted if the process was asked to stop: once, or as often as an InterruptPatience
/// says. Costs next to nothing; may be called by several threads.
void check_interrupts();

/// Work that ends only at the `count`-th interrupt (≥ 1) while this lives, e.g. episodes of a
/// campaign, which the first interrupt lets end.
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
