#include "harness/threads/executor.hpp"

#include <atomic>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace executor_test {

TEST(Executor, runs_every_task_exactly_once) {
  for (const int threads : {1, 2, 5}) {
    const controller::Executor run = executor_of(threads);
    for (const int count : {0, 1, 2, 1000}) {
      std::vector<std::atomic<int>> runs(static_cast<std::size_t>(count));
      run(count, [&](int n) { ++runs.at(static_cast<std::size_t>(n)); });
      for (int n = 0; n < count; ++n) {
        EXPECT_EQ(runs[static_cast<std::size_t>(n)], 1)
            << "task " << n << " of " << count << " on " << threads << " threads";
      }
    }
  }
}

TEST(Executor, has_ended_every_task_when_it_returns) {
  const controller::Executor run = executor_of(5);
  for (int round = 0; round < 200; ++round) {
    std::vector<int> squares(100);  // not atomic: read after all writes
    run(100, [&](int n) { squares[static_cast<std::size_t>(n)] = n * n; });
    EXPECT_EQ(std::accumulate(squares.begin(), squares.end(), 0), 328350);  // 99·100·199/6
  }
}

TEST(Executor, uses_no_more_threads_than_it_was_given) {
  for (const int threads : {1, 2, 5}) {
    std::mutex mutex;
    std::set<std::thread::id> seen;
    executor_of(threads)(10000, [&](int) {
      const std::scoped_lock lock(mutex);
      seen.insert(std::this_thread::get_id());
    });
    EXPECT_LE(seen.size(), static_cast<std::size_t>(threads));
    EXPECT_GE(seen.size(), 1U);
  }
}

TEST(Executor, of_one_thread_runs_in_turn_in_the_calling_thread) {
  const std::thread::id caller = std::this_thread::get_id();
  std::vector<int> order;
  executor_of(1)(5, [&](int n) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    order.push_back(n);
  });
  EXPECT_THAT(order, ::testing::ElementsAre(0, 1, 2, 3, 4));
}

TEST(Executor, a_copy_outlives_the_original) {
  controller::Executor copy;
  {
    const controller::Executor original = executor_of(2);
    copy = original;
  }
  std::atomic<int> sum = 0;
  copy(100, [&](int n) { sum += n; });
  EXPECT_EQ(sum, 4950);
}

// A task may itself run a loop over many particles on the executor.
TEST(Executor, a_task_may_use_it_again) {
  for (const int threads : {1, 2, 5}) {
    const controller::Executor run = executor_of(threads);
    std::atomic<int> runs = 0;
    run(10, [&](int) { run(10, [&](int) { ++runs; }); });
    EXPECT_EQ(runs, 100);
  }
}

TEST(Executor, what_a_task_throws_passes_through_and_the_next_call_works) {
  for (const int threads : {1, 2, 5}) {
    const controller::Executor run = executor_of(threads);
    try {
      run(1000, [](int n) {
        if (n == 700) throw std::runtime_error("task 700");
      });
      ADD_FAILURE() << "nothing was thrown on " << threads << " threads";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()), "task 700");
    }
    std::atomic<int> runs = 0;
    run(50, [&](int) { ++runs; });
    EXPECT_EQ(runs, 50);
  }
}

TEST(Executor, needs_a_thread) {
  EXPECT_THROW((void)executor_of(0), std::invalid_argument);
  EXPECT_THROW((void)executor_of(-3), std::invalid_argument);
}

}  // namespace executor_test
}  // namespace qsmpc::harness
