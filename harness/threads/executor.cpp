#include "harness/threads/executor.hpp"

#include <atomic>
#include <memory>
#include <stdexcept>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "harness/threads/sanitizers.hpp"

namespace qsmpc::harness {
namespace {

/// Makes the handover of work to other threads and back visible to the thread sanitizer: TBB
/// already orders these accesses, but is not compiled with the sanitizer.
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
    if (count == 1) return task(0);  // no other thread is involved
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
