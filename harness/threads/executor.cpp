#include "harness/threads/executor.hpp"

#include <atomic>
#include <memory>
#include <stdexcept>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "harness/threads/sanitizers.hpp"

namespace qsmpc::harness {
namespace {

/// How work goes to other threads and comes back, where the thread sanitizer can see it: TBB, which
/// orders all of this by itself, is not compiled with it.
class Handover {
 public:
#if QSMPC_THREAD_SANITIZER
  Handover() { given_.store(true, std::memory_order_release); }
  void take() { (void)given_.load(std::memory_order_acquire); }
  void give_back() { done_.fetch_add(1, std::memory_order_acq_rel); }
  void end() { (void)done_.load(std::memory_order_acquire); }

 private:
  std::atomic<bool> given_ = false;
  std::atomic<int> done_ = 0;
#else
  void take() {}
  void give_back() {}
  void end() {}
#endif
};

}  // namespace

controller::Executor executor_of(int threads) {
  if (threads < 1) throw std::invalid_argument("threads: at least one is needed");
  if (threads == 1) return controller::run_in_turn;
  auto arena = std::make_shared<tbb::task_arena>(threads);
  return [arena](int count, controller::TaskRef task) {
    if (count == 1) return task(0);  // it takes no other thread
    Handover handover;
    arena->execute([&] {
      tbb::parallel_for(0, count, [&](int n) {
        handover.take();
        task(n);
        handover.give_back();
      });
    });
    handover.end();
  };
}

}  // namespace qsmpc::harness
