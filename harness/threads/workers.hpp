// Plain threads for work that shares itself out: each worker takes pieces until none is left.
//
//   std::atomic<int> next = 0;
//   run_workers(available_threads(), [&](int) {
//     for (int n = next++; n < count; n = next++) work_on(n);
//   });
//
// Loops over many small tasks, nested ones above all, are an Executor's instead.
#pragma once

#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace qsmpc::harness {

/// Threads that the processor runs at once, at least 1.
[[nodiscard]] int available_threads();

/// How many of them to use where `asked` were asked for: all for 0 or fewer, and never more.
[[nodiscard]] int usable_threads(int asked);

/// Threads that work while their owner does something else.
class Workers {
 public:
  /// Called once on each thread, with its number.
  using Work = std::function<void(int)>;

  /// Starts `count` ≥ 0 threads, numbered from `first`. What `work` refers to outlives the Workers.
  /// Throws std::system_error where the system has no more threads, once those that were started
  /// have ended.
  explicit Workers(int count, Work work, int first = 0);
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  Workers(Workers&&) = delete;
  Workers& operator=(Workers&&) = delete;
  /// Waits for the threads; what they threw and `join` did not throw again is lost.
  ~Workers() = default;

  /// Waits for all threads, then throws what the first one that failed threw. The others are not
  /// told to stop: what they share has to say so.
  void join();

 private:
  friend void run_workers(int count, const Work& work);

  void run(int number) noexcept;

  Work work_;
  std::mutex mutex_;
  std::exception_ptr error_;           // the first
  std::vector<std::jthread> threads_;  // last: they use the rest
};

/// Calls work(0) … work(count − 1) at the same time, work(0) in the calling thread, and returns
/// once all have ended. Throws what the first one that failed threw. count: ≥ 1; throws
/// std::invalid_argument else.
void run_workers(int count, const Workers::Work& work);

}  // namespace qsmpc::harness
