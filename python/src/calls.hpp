// Long calls of the library: other Python threads run meanwhile, and Ctrl-C is heard.
#pragma once

#include <csignal>
#include <string>
#include <type_traits>

#include <nanobind/nanobind.h>

#include "harness/scenario/scenario.hpp"
#include "harness/threads/interruption.hpp"

namespace qsmpc::python {

/// While it lives, on the thread that Python's signals come to, Ctrl-C is noted as an interrupt of
/// the library's and handed on to Python, too.
class InterruptScope {
 public:
  InterruptScope();
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

  /// To be called with the interpreter's lock, once the work has ended: throws what Python makes of
  /// Ctrl-C, KeyboardInterrupt as a rule, if there was one.
  void raise_if_interrupted();

 private:
  bool is_caught_ = false;
  struct sigaction before_ = {};
};

/// work(), without the interpreter's lock. Throws what it throws; KeyboardInterrupt after Ctrl-C.
template <class Work>
auto without_lock(const Work& work) {
  InterruptScope interrupts;
  if constexpr (std::is_void_v<decltype(work())>) {
    {
      const nanobind::gil_scoped_release release;
      work();
    }
    interrupts.raise_if_interrupted();
  } else {
    auto result = [&] {
      const nanobind::gil_scoped_release release;
      return work();
    }();
    interrupts.raise_if_interrupted();
    return result;
  }
}

/// Throws InputError where `count` drives of `scenario` at the same time need more memory than
/// there is, before it is asked for.
void refuse_beyond_memory(const harness::Scenario& scenario, int count = 1);

/// str(value). To be called with the interpreter's lock.
[[nodiscard]] std::string text_of(const nanobind::handle& value);

/// "ValueError: …", of the exception that `error` holds; notes an interrupt if it is
/// KeyboardInterrupt, and throws Interrupted then. To be called with the interpreter's lock.
[[nodiscard]] std::string words_of(nanobind::python_error& error);

}  // namespace qsmpc::python
