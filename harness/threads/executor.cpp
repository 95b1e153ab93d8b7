#include "harness/threads/executor.hpp"

#include <memory>
#include <stdexcept>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace qsmpc {

Executor executor_of(int threads) {
  if (threads < 1) throw std::invalid_argument("threads: at least one is needed");
  if (threads == 1) return run_in_turn;
  auto arena = std::make_shared<tbb::task_arena>(threads);
  return [arena](int count, TaskRef task) {
    arena->execute([&] { tbb::parallel_for(0, count, [&](int n) { task(n); }); });
  };
}

}  // namespace qsmpc
