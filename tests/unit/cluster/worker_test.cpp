// Tasks and their gathered results, compared with one process that drives everything.
#include "harness/cluster/worker.hpp"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/campaign/runner.hpp"
#include "harness/cluster/gather.hpp"
#include "harness/cluster/launch_file.hpp"
#include "harness/cluster/task_report.hpp"
#include "harness/errors.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/campaign/campaign_fixture.hpp"

namespace qsmpc::harness {
namespace worker_test {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

/// All rows with their periods, without wall-clock values.
std::vector<EpisodeRow> rows_in(const std::string& folder) {
  const StoreReader store(folder);
  store.verify();
  std::vector<EpisodeRow> rows;
  for (const StoredVariant& variant : store.variants()) {
    const std::size_t begin = rows.size();
    store.for_each_episode(variant.id, [&](const EpisodeRow& row) {
      rows.push_back(row);
      rows.back().timing = {};
    });
    store.for_each_period(variant.id, [&](std::uint64_t seed, std::int64_t, PeriodRow period) {
      period.ocp_ms = 0.0;
      std::ranges::find(rows.begin() + static_cast<std::ptrdiff_t>(begin), rows.end(), seed,
                        &EpisodeRow::seed)
          ->periods.push_back(period);
    });
  }
  return rows;
}

class Tasks : public ::testing::Test {
 protected:
  void plan(const Campaign& campaign, std::int64_t lease_seeds) {
    write_lease_plan(lease_plan(campaign, lease_seeds), folder.path());
    write_task_launch({.launch = 1, .lost_after = std::chrono::seconds(1)}, folder.path());
  }

  WorkerEnd work(const WorkerOptions& options) const {
    const LeasePlan plan = read_lease_plan(folder.path());
    return run_worker(plan, planned_campaign(plan, folder.path()), folder.path(), options);
  }

  [[nodiscard]] Gathered gather() const {
    return gather_tasks(folder.path(), {.tasks_have_ended = true});
  }

  /// The rows of a single process.
  static std::vector<EpisodeRow> rows_of_one(const Campaign& campaign) {
    const TemporaryFolder one;
    (void)run_campaign(campaign, one.path(), {});
    return rows_in(one.path());
  }

  TemporaryFolder folder;
};

TEST_F(Tasks, drive_what_one_process_drives) {
  const Campaign campaign = testing::quick_campaign(10);
  plan(campaign, 2);
  std::atomic<std::int64_t> episodes = 0;
  {
    std::vector<std::jthread> tasks;
    for (int task = 1; task <= 3; ++task) {
      tasks.emplace_back([&, task] {
        const WorkerEnd end = work({.task = task, .jobs = 2});
        EXPECT_TRUE(end.all_finished);
        episodes += end.episodes;
      });
    }
  }
  EXPECT_EQ(episodes, 20);
  const Gathered gathered = gather();
  EXPECT_EQ(gathered.episodes, 20);
  EXPECT_EQ(gathered.total, 20);
  EXPECT_EQ(rows_in(folder.path()), rows_of_one(campaign));
  // A gathered campaign counts as done.
  EXPECT_EQ(run_campaign(campaign, folder.path(), {}).fresh, 0);
}

TEST_F(Tasks, give_back_what_they_have_begun_when_asked_to_stop) {
  const Campaign campaign = testing::quick_campaign(6);
  plan(campaign, 3);
  std::atomic<int> asked = 0;
  const WorkerEnd stopped = work({.task = 1, .should_stop = [&] { return ++asked > 3; }});
  EXPECT_FALSE(stopped.all_finished);
  EXPECT_GT(stopped.episodes, 0);
  EXPECT_LT(stopped.episodes, 6);
  const std::vector<LeaseClaim> claims = open_claims(folder.path());
  ASSERT_EQ(claims.size(), 1U);
  EXPECT_TRUE(claims[0].given_back);
  EXPECT_EQ(task_reports(folder.path()).at(0).word, TaskWord::kStopped);
  // The part of the lease that it drove is neither lost nor duplicated.
  EXPECT_EQ(gather().episodes, stopped.episodes);
  const WorkerEnd other = work({.task = 2});
  EXPECT_TRUE(other.all_finished);
  EXPECT_EQ(other.episodes, 12);
  EXPECT_EQ(gather().episodes, 12);
  EXPECT_EQ(rows_in(folder.path()), rows_of_one(campaign));
}

TEST_F(Tasks, keep_the_traces_that_one_process_keeps) {
  Campaign campaign = testing::quick_campaign(3);
  campaign.traces = TraceKeeping::kAll;
  plan(campaign, 1);
  EXPECT_TRUE(work({.task = 1, .jobs = 2}).all_finished);
  EXPECT_EQ(gather().episodes, 6);
  for (const EpisodeRow& row : rows_in(folder.path())) {
    EXPECT_EQ(row.trace, episode_folder(row.variant, row.seed));
    EXPECT_TRUE(fs::exists(folder / (row.trace + "/episode.h5"))) << row.trace;
  }
}

TEST_F(Tasks, have_nothing_to_do_where_all_is_finished) {
  plan(testing::quick_campaign(1), 1);
  EXPECT_TRUE(work({.task = 1}).all_finished);
  const WorkerEnd again = work({.task = 1});
  EXPECT_TRUE(again.all_finished);
  EXPECT_EQ(again.episodes, 0);
  EXPECT_EQ(task_reports(folder.path()).size(), 1U);
}

/// Puts a task's made-up store into the folder: rows of all episodes, changed by `change`.
void put_store(const std::string& folder, int task,
               const std::function<void(EpisodeRow&)>& change) {
  const LeasePlan plan = read_lease_plan(folder);
  LeaseHolder holder{.task = task, .launch = 1};
  make_task_folder(folder, holder);
  Store store(task_folder(folder, holder), plan.identity.campaign, plan.identity.variants,
              plan.seeds, false, StoreUse::kAlone);
  for (std::int64_t variant = 0; variant < 2; ++variant) {
    for (std::int64_t index = 0; index < plan.seeds.size(); ++index) {
      EpisodeRow row = testing::example_row(variant, plan.seeds.at(index));
      change(row);
      store.add(row, false);
    }
  }
  store.fold();
  write_task_report(folder, {.holder = holder, .word = TaskWord::kDone});
}

TEST_F(Tasks, may_drive_the_same_episodes_and_the_first_ones_are_taken) {
  plan(testing::quick_campaign(2), 1);
  put_store(folder.path(), 10, [](EpisodeRow& row) { row.timing.wall_ms = 10.0; });
  put_store(folder.path(), 9, [](EpisodeRow& row) {
    row.timing.wall_ms = 9.0;
    row.periods[0].ocp_ms = 99.0;
  });
  EXPECT_EQ(gather().episodes, 4);
  const StoreReader store(folder.path());
  store.verify();
  store.for_each_episode(0, [](const EpisodeRow& row) { EXPECT_EQ(row.timing.wall_ms, 9.0); });
}

TEST_F(Tasks, that_disagree_are_refused_with_the_episode) {
  const std::vector<std::function<void(EpisodeRow&)>> changes{
      [](EpisodeRow& row) { row.cost += 1e-12 * row.cost; },
      [](EpisodeRow& row) { row.outcome = "collision"; },
      [](EpisodeRow& row) { row.periods[1].certified = 3e-3; },
      [](EpisodeRow& row) { row.periods.pop_back(); },
      [](EpisodeRow& row) { row.believed_max.reset(); }};
  for (std::size_t n = 0; n < changes.size(); ++n) {
    fs::remove_all(folder.path());
    fs::create_directories(folder.path());
    plan(testing::quick_campaign(2), 1);
    put_store(folder.path(), 1, [](EpisodeRow&) {});
    put_store(folder.path(), 2, [&](EpisodeRow& row) {
      if (row.variant == 1 && row.seed == 6) changes[n](row);
    });
    try {
      (void)gather();
      ADD_FAILURE() << "change " << n << " is not seen";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr("two"), HasSubstr("6")));
      EXPECT_FALSE(fs::exists(folder / "campaign.sqlite"));
    }
  }
}

TEST_F(Tasks, that_still_work_are_not_gathered) {
  plan(testing::quick_campaign(1), 1);
  put_store(folder.path(), 1, [](EpisodeRow&) {});
  TaskReport report = task_reports(folder.path()).at(0);
  report.word = TaskWord::kWorking;
  write_task_report(folder.path(), report);
  const auto gather_while = [&](const std::function<void()>& meanwhile) {
    return gather_tasks(folder.path(), {.sleep = [&] {
                          std::this_thread::sleep_for(std::chrono::milliseconds(20));
                          meanwhile();
                        }});
  };
  try {
    (void)gather_while([&] {
      ++report.beat;
      write_task_report(folder.path(), report);
    });
    ADD_FAILURE() << "gathered";
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("task 1 (process"));
  }
  // The task was killed, then.
  EXPECT_EQ(gather_while([] {}).episodes, 2);
  // Tasks of earlier launches are known to have ended.
  write_task_launch({.launch = 2}, folder.path());
  EXPECT_EQ(gather_while([] { ADD_FAILURE() << "watched"; }).episodes, 2);
}

TEST_F(Tasks, fail_in_one_line_where_the_folder_vanishes) {
  const Campaign campaign = testing::quick_campaign(20);
  plan(campaign, 1);
  std::atomic<int> asked = 0;
  WorkerOptions options{.task = 1};
  options.should_stop = [&] {
    if (++asked == 3) fs::rename(folder / "cluster", folder / "gone");
    return false;
  };
  try {
    (void)work(options);
    ADD_FAILURE() << "not told";
  } catch (const IoError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
  // The folder comes back, and another task drives what was begun.
  fs::rename(folder / "gone", folder / "cluster");
  EXPECT_TRUE(work({.task = 2, .jobs = 2}).all_finished);
  EXPECT_EQ(gather().episodes, 40);
  EXPECT_EQ(rows_in(folder.path()), rows_of_one(campaign));
}

}  // namespace worker_test
}  // namespace qsmpc::harness
