#include "harness/threads/workers.hpp"

#include <atomic>
#include <cstddef>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sched.h>

namespace qsmpc::harness {
namespace workers_test {

TEST(AvailableThreads, are_at_least_one_and_bound_what_is_asked_for) {
  EXPECT_GE(available_threads(), 1);
  EXPECT_EQ(usable_threads(0), available_threads());
  EXPECT_EQ(usable_threads(1), 1);
  EXPECT_EQ(usable_threads(available_threads() + 1), available_threads());
}

TEST(AvailableThreads, are_those_that_the_process_may_use) {
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof(before), &before), 0);
  EXPECT_EQ(available_threads(), CPU_COUNT(&before));
  int first = 0;
  while (!CPU_ISSET(first, &before)) ++first;
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(first, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);
  EXPECT_EQ(available_threads(), 1);
  ASSERT_EQ(sched_setaffinity(0, sizeof(before), &before), 0);
}

TEST(RunWorkers, calls_each_worker_once_and_the_first_in_the_calling_thread) {
  for (const int count : {1, 2, 7}) {
    std::vector<std::thread::id> threads(static_cast<std::size_t>(count));
    run_workers(count, [&](int worker) {
      threads.at(static_cast<std::size_t>(worker)) = std::this_thread::get_id();
    });
    EXPECT_EQ(threads.front(), std::this_thread::get_id());
    EXPECT_EQ(std::set(threads.begin(), threads.end()).size(), threads.size());
    EXPECT_FALSE(std::set(threads.begin(), threads.end()).contains(std::thread::id{}));
  }
}

TEST(RunWorkers, all_work_at_the_same_time) {
  constexpr int kCount = 4;
  std::atomic<int> arrived = 0;
  // Would wait forever if a worker only started after another had ended.
  run_workers(kCount, [&](int) {
    ++arrived;
    while (arrived < kCount) std::this_thread::yield();
  });
  EXPECT_EQ(arrived, kCount);
}

TEST(RunWorkers, throws_the_first_failure_once_all_have_ended) {
  for (const int failing : {0, 2}) {
    std::atomic<int> ended = 0;
    std::atomic<bool> failed = false;
    const auto work = [&](int worker) {
      if (worker == failing) {
        failed = true;
        throw std::runtime_error("first");
      }
      while (!failed) std::this_thread::yield();
      ++ended;
    };
    EXPECT_THROW(run_workers(3, work), std::runtime_error);
    EXPECT_EQ(ended, 2);
  }
}

TEST(RunWorkers, refuse_none) {
  EXPECT_THROW(run_workers(0, [](int) {}), std::invalid_argument);
}

TEST(Workers, work_while_their_owner_does_something_else) {
  std::atomic<bool> told = false;
  std::atomic<int> sum = 0;
  Workers workers(
      2,
      [&](int number) {
        while (!told) std::this_thread::yield();
        sum += number;
      },
      5);
  told = true;
  workers.join();
  EXPECT_EQ(sum, 5 + 6);
}

TEST(Workers, destroying_them_waits_and_drops_what_they_threw) {
  std::atomic<int> ended = 0;
  {
    const Workers workers(3, [&](int) {
      ++ended;
      throw std::runtime_error("lost");
    });
  }
  EXPECT_EQ(ended, 3);
}

}  // namespace workers_test
}  // namespace qsmpc::harness
