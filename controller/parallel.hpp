// Parallel loops over many particles. The controller owns no threads.
//
// A caller that owns threads supplies an Executor; without one everything runs serially. Work is
// divided in the same way for every executor, and partial results are combined in a fixed order, so
// that no result depends on the executor.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <type_traits>

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// Non-owning reference to a callable that takes a task's number; must not outlive it. Never
/// allocates.
class TaskRef {
 public:
  template <class Callable>
  requires(!std::is_same_v<std::remove_cvref_t<Callable>, TaskRef>)
      // NOLINTNEXTLINE(bugprone-forwarding-reference-overload): copies are excluded above.
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

/// Runs the tasks one after the other in the calling thread.
inline void run_in_turn(int count, TaskRef task) {
  for (int n = 0; n < count; ++n) task(n);
}

/// The particles begin … end − 1.
struct ParticleRange {
  std::ptrdiff_t begin = 0;
  std::ptrdiff_t end = 0;
};

/// Particles per task. A multiple of eight, so that sums have the same interleaved parts in every
/// chunk.
inline constexpr std::ptrdiff_t kChunk = 1024;

[[nodiscard]] inline int chunks_of(std::ptrdiff_t particles) {
  return static_cast<int>((particles + kChunk - 1) / kChunk);
}

[[nodiscard]] inline ParticleRange chunk_range(int chunk, std::ptrdiff_t particles) {
  return {chunk * kChunk, std::min((chunk + 1) * kChunk, particles)};
}

/// Calls task(range, chunk) for all chunks of the particles. Even a single chunk goes through the
/// executor, so that an executor that may throw, e.g. to stop the work, is called in every loop.
template <class Task>
void for_chunks(const Executor& run, std::ptrdiff_t particles, const Task& task) {
  run(chunks_of(particles), [&](int chunk) { task(chunk_range(chunk, particles), chunk); });
}

}  // namespace qsmpc::controller

#pragma GCC visibility pop
