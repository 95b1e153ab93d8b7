// Long calls of the library: other Python threads run meanwhile, and Ctrl-C is handled.
#pragma once

#include <csignal>
#include <string>
#include <type_traits>

#include <nanobind/nanobind.h>

#include "harness/scenario/scenario.hpp"
#include "harness/threads/interruption.hpp"

namespace qsmpc::python {

/// While it lives on the thread that receives Python's signals, Ctrl-C is recorded as an interrupt
/// of the library and also forwarded to Python.
class InterruptScope {
 public:
  InterruptScope();
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

  /// To be called with the interpreter's lock once the work has ended. If Ctrl-C was pressed,
  /// throws the exception that Python raises for it, usually KeyboardInterrupt.
  void raise_if_interrupted();

 private:
  bool is_caught_ = false;
  struct sigaction before_ = {};
};

/// Calls work() without the interpreter's lock. Its exceptions pass through; throws
/// KeyboardInterrupt after Ctrl-C.
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

/// Throws InputError if `count` simultaneous drives of `scenario` need more memory than there is,
/// before any is allocated.
void refuse_beyond_memory(const harness::Scenario& scenario, int count = 1);

/// str(value). To be called with the interpreter's lock.
[[nodiscard]] std::string text_of(const nanobind::handle& value);

/// "ValueError: …" for the exception that `error` holds. If that is KeyboardInterrupt, records an
/// interrupt and throws Interrupted. To be called with the interpreter's lock.
[[nodiscard]] std::string words_of(nanobind::python_error& error);

}  // namespace qsmpc::python
