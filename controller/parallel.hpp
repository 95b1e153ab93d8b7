// How the controller's loops over many particles run side by side, without threads of its own.
//
// Whoever has threads hands over an Executor; without one everything runs in turn. Work is divided
// in the same way whatever the executor, and partial results are combined in a fixed order, so that
// no result depends on it.
#pragma once

#include <functional>
#include <memory>
#include <type_traits>

namespace qsmpc {

/// Refers to something callable with a task's number; must not outlive it. Never allocates.
class TaskRef {
 public:
  template <class Callable>
  requires(!std::is_same_v<std::remove_cvref_t<Callable>, TaskRef>)
      // NOLINTNEXTLINE(google-explicit-constructor): a lambda is passed where a task is wanted.
      TaskRef(Callable&& callable)
      : object_(const_cast<void*>(static_cast<const void*>(std::addressof(callable)))),
        call_([](void* object, int task) {
          (*static_cast<std::remove_reference_t<Callable>*>(object))(task);
        }) {}
  void operator()(int task) const { call_(object_, task); }

 private:
  void* object_;
  void (*call_)(void*, int);
};

/// Runs task(0) … task(count − 1), in any order and possibly at the same time, and returns when all
/// are done.
using Executor = std::function<void(int count, TaskRef task)>;

/// One after the other, in the calling thread.
inline void run_in_turn(int count, TaskRef task) {
  for (int n = 0; n < count; ++n) task(n);
}

}  // namespace qsmpc
