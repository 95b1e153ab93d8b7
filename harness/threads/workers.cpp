#include "harness/threads/workers.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <sched.h>

namespace qsmpc::harness {

int available_threads() {
  // What taskset, cpusets and batch systems leave to this process.
  cpu_set_t processors;
  if (sched_getaffinity(0, sizeof(processors), &processors) == 0) return CPU_COUNT(&processors);
  // hardware_concurrency() is 0 if the system does not tell.
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

int usable_threads(int asked) {
  return asked > 0 ? std::min(asked, available_threads()) : available_threads();
}

Workers::Workers(int count, Work work, int first) : work_(std::move(work)) {
  for (int n = 0; n < count; ++n) {
    threads_.emplace_back([this, number = first + n] { run(number); });
  }
}

void Workers::run(int number) noexcept {
  try {
    work_(number);
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = std::current_exception();
  }
}

void Workers::join() {
  threads_.clear();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void run_workers(int count, const Workers::Work& work) {
  if (count < 1) throw std::invalid_argument("workers: at least one is needed");
  Workers workers(count - 1, work, 1);
  workers.run(0);
  workers.join();
}

}  // namespace qsmpc::harness
