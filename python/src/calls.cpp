#include "python/src/calls.hpp"

#include <atomic>
#include <string>

#include "harness/assembly/memory_need.hpp"
#include "harness/errors.hpp"

namespace qsmpc::python {
namespace {

namespace nb = nanobind;

// Python's own handler, which turns the signal into a KeyboardInterrupt.
void (*python_handler)(int) = nullptr;

// Calls may be nested (a Python controller within a drive) and come from several threads.
std::atomic<int> scopes = 0;

extern "C" void note_and_hand_on(int number) {
  harness::note_interrupt();
  if (python_handler != nullptr) python_handler(number);
}

/// Whether this is the thread on which Python runs its signal handlers.
bool is_main_thread() {
  const nb::module_ threading = nb::module_::import_("threading");
  return threading.attr("current_thread")().is(threading.attr("main_thread")());
}

}  // namespace

InterruptScope::InterruptScope() {
  if (scopes++ == 0) harness::forget_interrupts();
  if (!is_main_thread()) return;
  if (sigaction(SIGINT, nullptr, &before_) != 0) return;
  // If the handler was replaced or SIGINT is ignored, no KeyboardInterrupt is wanted; if it is
  // ours, an outer call already catches SIGINT.
  if ((before_.sa_flags & SA_SIGINFO) != 0 || before_.sa_handler == SIG_IGN ||
      before_.sa_handler == SIG_DFL || before_.sa_handler == note_and_hand_on) {
    return;
  }
  python_handler = before_.sa_handler;
  struct sigaction action = {};
  action.sa_handler = note_and_hand_on;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  is_caught_ = sigaction(SIGINT, &action, nullptr) == 0;
}

InterruptScope::~InterruptScope() {
  if (is_caught_) sigaction(SIGINT, &before_, nullptr);
  if (--scopes == 0) harness::forget_interrupts();
}

void InterruptScope::raise_if_interrupted() {
  if (PyErr_CheckSignals() != 0) throw nb::python_error();
}

void refuse_beyond_memory(const harness::Scenario& scenario, int count) {
  const auto problem = harness::memory_problem(scenario, count, harness::usable_memory());
  if (!problem) return;
  throw harness::InputError(
      {.file = scenario.name, .found = problem->found, .expected = problem->expected});
}

std::string text_of(const nb::handle& value) { return nb::str(value).c_str(); }

std::string words_of(nb::python_error& error) {
  if (error.matches(PyExc_KeyboardInterrupt)) {
    harness::note_interrupt();
    throw harness::Interrupted();
  }
  const std::string name = text_of(error.type().attr("__name__"));
  const std::string words = text_of(error.value());
  return words.empty() ? name : name + ": " + words;
}

}  // namespace qsmpc::python
