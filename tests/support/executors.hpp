// Executors with adversarial task order and concurrency: results must not depend on them.
#pragma once

#include <atomic>
#include <thread>
#include <vector>

#include "controller/parallel.hpp"

namespace qsmpc::testing {

inline void run_backwards(int count, controller::TaskRef task) {
  for (int n = count - 1; n >= 0; --n) task(n);
}

/// Three threads that take tasks in turn.
inline void run_on_threads(int count, controller::TaskRef task) {
  constexpr int kThreads = 3;
  std::atomic<int> next{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&] {
      for (int n = next++; n < count; n = next++) task(n);
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace qsmpc::testing
