// Each lease is driven by one task while all are alive, and by another one if its task is lost.
#include "harness/cluster/lease_queue.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <latch>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/cluster/lease_plan.hpp"
#include "harness/errors.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace lease_queue_test {

namespace fs = std::filesystem;
using std::chrono::hours;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

class LeaseQueues : public ::testing::Test {
 protected:
  LeaseQueues() {
    for (const char* name : {kClaimsFolder, kFinishedFolder, kTasksFolder}) {
      fs::create_directories(cluster_path(folder.path(), name));
    }
  }

  /// The queue of a task with the test's clock shifted by `offset`.
  [[nodiscard]] std::unique_ptr<LeaseQueue> queue(const LeaseHolder& holder,
                                                  std::int64_t leases = 1,
                                                  LeaseQueue::Clock::duration offset = {}) {
    return std::make_unique<LeaseQueue>(
        folder.path(), LeaseQueue::Options{.leases = leases,
                                           .me = holder,
                                           .lost_after = seconds(100),
                                           .now = [this, offset] { return now + offset; }});
  }

  TemporaryFolder folder;
  LeaseQueue::Clock::time_point now = LeaseQueue::Clock::now();
};

/// Runs `work` with 0 … count − 1 on threads that start simultaneously.
void race(int count, const std::function<void(int)>& work) {
  std::latch ready(count);
  std::vector<std::jthread> threads;
  for (int n = 0; n < count; ++n) {
    threads.emplace_back([&, n] {
      ready.arrive_and_wait();
      work(n);
    });
  }
}

TEST_F(LeaseQueues, are_given_out_in_order) {
  const auto one = queue({.task = 1}, 3);
  const auto two = queue({.task = 2}, 3);
  EXPECT_EQ(one->claim(), 0);
  EXPECT_EQ(two->claim(), 1);
  EXPECT_EQ(one->claim(), 2);
  EXPECT_EQ(two->claim(), std::nullopt);
  EXPECT_FALSE(two->all_finished());
}

TEST_F(LeaseQueues, give_each_lease_to_one_of_threads_that_race) {
  constexpr int kLeases = 200;
  std::vector<std::atomic<int>> given(kLeases);
  race(4, [&](int n) {
    const auto mine = queue({.task = n + 1}, kLeases);
    while (const auto lease = mine->claim()) ++given[static_cast<std::size_t>(*lease)];
  });
  for (const auto& times : given) EXPECT_EQ(times, 1);
}

TEST_F(LeaseQueues, give_each_lease_to_one_of_processes_that_race) {
  constexpr int kLeases = 200;
  constexpr int kProcesses = 4;
  for (int n = 0; n < kProcesses; ++n) {
    if (fork() != 0) continue;
    std::ofstream out(folder / fmt::format("{}", n));
    const auto mine = queue({.task = n + 1}, kLeases);
    while (const auto lease = mine->claim()) out << *lease << "\n";
    out.flush();
    _exit(0);
  }
  for (int n = 0; n < kProcesses; ++n) wait(nullptr);
  std::vector<int> given(kLeases);
  for (int n = 0; n < kProcesses; ++n) {
    std::ifstream in(folder / fmt::format("{}", n));
    for (int lease = 0; in >> lease;) ++given.at(static_cast<std::size_t>(lease));
  }
  EXPECT_THAT(given, ::testing::Each(1));
}

TEST_F(LeaseQueues, take_over_a_lease_whose_holder_gives_no_sign) {
  const auto lost = queue({.task = 1});
  ASSERT_EQ(lost->claim(), 0);
  const auto other = queue({.task = 2});
  EXPECT_EQ(other->claim(), std::nullopt);
  now += seconds(99);
  EXPECT_EQ(other->claim(), std::nullopt);
  now += seconds(2);
  EXPECT_EQ(other->claim(), 0);
}

TEST_F(LeaseQueues, leave_a_lease_to_a_holder_that_gives_signs) {
  const auto slow = queue({.task = 1});
  ASSERT_EQ(slow->claim(), 0);
  const auto other = queue({.task = 2});
  for (int n = 0; n < 20; ++n) {
    now += seconds(60);
    slow->beat();
    EXPECT_EQ(other->claim(), std::nullopt) << n;
  }
}

TEST_F(LeaseQueues, let_one_of_many_take_a_lost_lease_over) {
  for (int round = 0; round < 20; ++round) {
    const std::string claims = cluster_path(folder.path(), kClaimsFolder);
    fs::remove_all(claims);
    fs::create_directories(claims);
    ASSERT_EQ(queue({.task = 1})->claim(), 0);
    std::vector<std::unique_ptr<LeaseQueue>> others;
    for (int n = 0; n < 6; ++n) {
      others.push_back(queue({.task = n + 2}));
      ASSERT_EQ(others.back()->claim(), std::nullopt);
    }
    now += seconds(101);
    std::atomic<int> taken = 0;
    race(6, [&](int n) {
      if (others[static_cast<std::size_t>(n)]->claim()) ++taken;
    });
    EXPECT_EQ(taken, 1);
  }
}

TEST_F(LeaseQueues, let_one_take_over_who_took_over_and_is_lost_as_well) {
  ASSERT_EQ(queue({.task = 1})->claim(), 0);
  const auto second = queue({.task = 2});
  const auto third = queue({.task = 3});
  ASSERT_EQ(second->claim(), std::nullopt);
  ASSERT_EQ(third->claim(), std::nullopt);
  now += seconds(101);
  ASSERT_EQ(second->claim(), 0);
  // What the third has observed of the first does not apply to the second.
  EXPECT_EQ(third->claim(), std::nullopt);
  now += seconds(101);
  EXPECT_EQ(third->claim(), 0);
}

TEST_F(LeaseQueues, do_not_compare_clocks) {
  const auto ahead = queue({.task = 1}, 1, hours(7));
  ASSERT_EQ(ahead->claim(), 0);
  for (const auto& entry : fs::directory_iterator(cluster_path(folder.path(), kClaimsFolder))) {
    fs::last_write_time(entry.path(), fs::file_time_type::clock::now() - hours(30));
  }
  const auto behind = queue({.task = 2}, 1, -hours(9));
  const auto far_ahead = queue({.task = 3}, 1, hours(100));
  EXPECT_EQ(behind->claim(), std::nullopt);
  EXPECT_EQ(far_ahead->claim(), std::nullopt);
  ahead->beat();
  now += seconds(60);
  EXPECT_EQ(far_ahead->claim(), std::nullopt);
  EXPECT_EQ(behind->claim(), std::nullopt);
  now += seconds(101);
  EXPECT_EQ(behind->claim(), 0);
}

TEST_F(LeaseQueues, take_a_lease_at_once_that_was_given_back) {
  const auto one = queue({.task = 1}, 2);
  ASSERT_EQ(one->claim(), 0);
  ASSERT_EQ(one->claim(), 1);
  one->finish(0, {});
  one->give_back();
  const auto two = queue({.task = 2}, 2);
  EXPECT_EQ(two->claim(), 1);
  EXPECT_EQ(two->claim(), std::nullopt);
}

TEST_F(LeaseQueues, take_a_lease_at_once_of_an_earlier_launch_or_start_of_the_task) {
  ASSERT_EQ(queue({.task = 1, .launch = 1})->claim(), 0);
  EXPECT_EQ(queue({.task = 2, .launch = 2})->claim(), 0);
  EXPECT_EQ(queue({.task = 3, .launch = 2})->claim(), std::nullopt);
  EXPECT_EQ(queue({.task = 2, .start = 2, .launch = 2})->claim(), 0);
  EXPECT_EQ(queue({.task = 2, .start = 1, .launch = 2})->claim(), std::nullopt);
}

TEST_F(LeaseQueues, are_finished_once_also_by_two) {
  const std::vector<SeedOutcomes> outcomes{
      {.seed_index = 0, .outcomes = {"reached", "collision"}, .unsafe = {false, true}}};
  const auto slow = queue({.task = 1});
  ASSERT_EQ(slow->claim(), 0);
  const auto other = queue({.task = 2});
  ASSERT_EQ(other->claim(), std::nullopt);
  now += seconds(101);
  ASSERT_EQ(other->claim(), 0);
  other->finish(0, outcomes);
  slow->beat();
  slow->finish(0, outcomes);
  EXPECT_THAT(finished_leases(folder.path()), ElementsAre(0));
  EXPECT_EQ(finished_outcomes(folder.path(), 0), outcomes);
  for (const auto& queue : {slow.get(), other.get()}) {
    EXPECT_EQ(queue->claim(), std::nullopt);
    EXPECT_TRUE(queue->all_finished());
  }
  EXPECT_TRUE(open_claims(folder.path()).empty());
}

TEST_F(LeaseQueues, take_over_a_claim_that_was_never_written_to_its_end) {
  std::ofstream(cluster_path(folder.path(), kClaimsFolder) + "/0.0") << "{\"task\": 1, \"st";
  const auto other = queue({.task = 2});
  EXPECT_EQ(other->claim(), std::nullopt);
  EXPECT_TRUE(open_claims(folder.path()).empty());
  now += seconds(101);
  EXPECT_EQ(other->claim(), 0);
}

TEST_F(LeaseQueues, list_who_holds_which_lease) {
  const auto one = queue({.task = 4, .start = 2, .launch = 3, .host = "n1", .process = 17}, 3);
  ASSERT_EQ(one->claim(), 0);
  ASSERT_EQ(one->claim(), 1);
  one->finish(0, {});
  const std::vector<LeaseClaim> claims = open_claims(folder.path());
  ASSERT_EQ(claims.size(), 1U);
  EXPECT_EQ(claims[0].lease, 1);
  EXPECT_EQ(claims[0].generation, 0);
  EXPECT_EQ(claims[0].holder,
            (LeaseHolder{.task = 4, .start = 2, .launch = 3, .host = "n1", .process = 17}));
  EXPECT_FALSE(claims[0].given_back);
}

TEST_F(LeaseQueues, report_that_the_folder_has_vanished) {
  const auto one = queue({.task = 1}, 3);
  ASSERT_EQ(one->claim(), 0);
  fs::remove_all(folder / kClusterFolder);
  for (const std::function<void()>& use : std::initializer_list<std::function<void()>>{
           [&] { (void)one->claim(); }, [&] { one->beat(); }, [&] { one->finish(0, {}); },
           [&] { one->give_back(); }}) {
    try {
      use();
      ADD_FAILURE() << "not told";
    } catch (const IoError& error) {
      EXPECT_THAT(error.what(), HasSubstr("No such file or directory"));
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

}  // namespace lease_queue_test
}  // namespace qsmpc::harness
