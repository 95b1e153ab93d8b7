// Plain threads for self-scheduling work: each worker takes pieces until none are left.
//
//   std::atomic<int> next = 0;
//   run_workers(available_threads(), [&](int) {
//     for (int n = next++; n < count; n = next++) work_on(n);
//   });
//
// For loops over many small tasks, nested ones above all, use an Executor instead.
#pragma once

#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace qsmpc::harness {

/// Number of threads that run concurrently on the processors left to this process (by taskset or a
/// batch system, for example), at least 1.
[[nodiscard]] int available_threads();

/// How many of them to use if `asked` are requested: all of them for 0 or fewer, and never more
/// than all.
[[nodiscard]] int usable_threads(int asked);

/// Threads that run while their owner does other work.
class Workers {
 public:
  /// Called once on each thread, with its number.
  using Work = std::function<void(int)>;

  /// Starts `count` ≥ 0 threads, numbered from `first`. What `work` refers to must outlive the
  /// Workers. If the system has no more threads, throws std::system_error once those already
  /// started have ended.
  explicit Workers(int count, Work work, int first = 0);
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  Workers(Workers&&) = delete;
  Workers& operator=(Workers&&) = delete;
  /// Waits for the threads; exceptions that `join` has not rethrown are lost.
  ~Workers() = default;

  /// Waits for all threads, then rethrows the exception of the first one that failed. The others
  /// are not stopped; shared state has to tell them to stop.
  void join();

 private:
  friend void run_workers(int count, const Work& work);

  void run(int number) noexcept;

  Work work_;
  std::mutex mutex_;
  std::exception_ptr error_;           // the first
  std::vector<std::jthread> threads_;  // last: they use the rest
};

/// Calls work(0) … work(count − 1) concurrently, work(0) in the calling thread, and returns once
/// all have ended. Rethrows the exception of the first one that failed. count: ≥ 1, otherwise
/// throws std::invalid_argument.
void run_workers(int count, const Workers::Work& work);

}  // namespace qsmpc::harness
