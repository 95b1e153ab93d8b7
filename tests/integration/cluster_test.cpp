// Campaigns that several processes run through a shared folder: the result equals that of one
// process, whatever happens to the others.

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/campaign/plan/campaign_file.hpp"
#include "harness/cluster/launch_file.hpp"
#include "harness/cluster/lease_plan.hpp"
#include "harness/cluster/lease_queue.hpp"
#include "harness/cluster/task_report.hpp"
#include "tests/integration/campaign_fixture.hpp"
#include "tests/support/effort.hpp"

namespace qsmpc::harness {
namespace cluster_test {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::ProcessOptions;
using testing::ProcessResult;
using testing::run_qsmpc;
using testing::TemporaryFolder;

/// Names of the traces that belong to the campaign in `folder`, excluding those in its tasks'
/// folders.
std::vector<std::string> own_traces(const std::string& folder) {
  std::vector<std::string> names = testing::files_below(folder, ".h5");
  std::erase_if(names, [](const std::string& name) { return name.starts_with("cluster/"); });
  return names;
}

/// A campaign, its result from one process, and the folder in which tasks run it.
class Cluster : public ::testing::Test {
 protected:
  void drive_whole(int seeds, const std::string& extra = "") {
    file = testing::short_campaign(folder, seeds, extra);
    const ProcessResult result = run_qsmpc({"campaign", file, "--out", whole, "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }

  [[nodiscard]] ProcessResult with_tasks(const ProcessOptions& options = {},
                                         std::vector<std::string> more = {"--quiet"}) const {
    std::vector<std::string> words{"campaign", file, "--on",    "local", "--tasks",      "3",
                                   "--jobs",   "1",  "--lease", "2",     "--lost-after", "1",
                                   "--out",    out};
    words.insert(words.end(), more.begin(), more.end());
    return run_qsmpc(words, options);
  }

  /// Plans the campaign in `out` as hand-started tasks find it.
  void plan(std::int64_t lease_seeds = 2) const {
    fs::create_directories(out);
    write_lease_plan(lease_plan(load_campaign(file), lease_seeds), out);
    write_task_launch({.launch = 1, .lost_after = std::chrono::seconds(1)}, out);
  }

  [[nodiscard]] ProcessResult work(int task, const ProcessOptions& options = {}) const {
    return run_qsmpc({"campaign", "work", out, "--task", std::to_string(task), "--jobs", "1"},
                     options);
  }

  [[nodiscard]] ProcessResult gather() const {
    return run_qsmpc({"campaign", "gather", out, "--quiet"});
  }

  void expect_whole() const {
    EXPECT_EQ(testing::rows_of(out), testing::rows_of(whole));
    EXPECT_EQ(testing::results_of(out), testing::results_of(whole));
    EXPECT_EQ(own_traces(out), own_traces(whole));
    // Killed tasks may have left partial files in their own folders.
    std::vector<std::string> partial = testing::files_below(out, ".partial");
    std::erase_if(partial, [](const std::string& name) { return name.starts_with("cluster/"); });
    EXPECT_TRUE(partial.empty());
  }

  /// Processes of the tasks that report working.
  [[nodiscard]] std::vector<pid_t> working() const {
    std::vector<pid_t> processes;
    std::error_code ignored;
    if (!fs::exists(cluster_path(out, kTasksFolder), ignored)) return processes;
    for (const TaskReport& report : task_reports(out)) {
      if (report.word == TaskWord::kWorking) {
        processes.push_back(static_cast<pid_t>(report.holder.process));
      }
    }
    return processes;
  }

  [[nodiscard]] std::size_t finished() const {
    std::error_code ignored;
    return fs::exists(cluster_path(out, kFinishedFolder), ignored) ? finished_leases(out).size()
                                                                   : 0;
  }

  TemporaryFolder folder;
  std::string file;
  std::string whole = folder / "whole";
  std::string out = folder / "out";
};

TEST_F(Cluster, three_tasks_leave_what_one_process_leaves) {
  drive_whole(9, "traces: failures\ntrace_sample: 3\n");
  const ProcessResult result = with_tasks({}, {});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  expect_whole();
  EXPECT_THAT(result.errors, HasSubstr("driving: 18 of 18"));
  EXPECT_THAT(result.output, AllOf(HasSubstr("closed"), HasSubstr("open")));
  for (const char* name : {"campaign.yaml", "report.html", "campaign.json"}) {
    EXPECT_TRUE(testing::files_in(out).contains(name)) << name;
  }
  EXPECT_TRUE(testing::files_below(out, "-wal").empty());
  // A single process considers the campaign done, and tasks find nothing to do.
  EXPECT_EQ(run_qsmpc({"campaign", file, "--out", out, "--quiet"}).exit_code, 0);
  EXPECT_EQ(with_tasks().exit_code, 0);
  EXPECT_EQ(run_qsmpc({"campaign", "resume", out, "--quiet"}).exit_code, 0);
  expect_whole();
}

TEST_F(Cluster, a_task_that_is_killed_is_made_up_for_by_the_others) {
  drive_whole(16);
  ProcessOptions options;
  options.meanwhile = [&](pid_t) {
    const std::vector<pid_t> processes = working();
    if (processes.size() < 3 || finished() < 2) return false;
    kill(processes[1], SIGKILL);
    return true;
  };
  const ProcessResult result = with_tasks(options);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("qsmpc: task"));
  expect_whole();
}

TEST_F(Cluster, a_task_that_sleeps_and_wakes_up_does_no_harm) {
  drive_whole(20);
  ProcessOptions options;
  pid_t asleep = 0;
  std::chrono::steady_clock::time_point since{};
  options.meanwhile = [&](pid_t) {
    const std::vector<pid_t> processes = working();
    if (asleep == 0) {
      if (processes.size() < 3 || finished() < 2) return false;
      asleep = processes[0];
      kill(asleep, SIGSTOP);
      since = std::chrono::steady_clock::now();
      return false;
    }
    // Waits until others have driven what it had begun.
    const bool is_all = finished() == 10;
    if (!is_all && std::chrono::steady_clock::now() - since < std::chrono::seconds(20))
      return false;
    EXPECT_TRUE(is_all);
    kill(asleep, SIGCONT);
    return true;
  };
  const ProcessResult result = with_tasks(options);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  expect_whole();
}

TEST_F(Cluster, killed_with_all_tasks_at_any_moment_and_resumed_it_ends_as_if_it_never_was) {
  drive_whole(12, "traces: all\n");
  std::mt19937 random(5);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the clock adds the rest
  for (int round = 0; round < testing::by_effort(1, 3, 40); ++round) {
    fs::remove_all(out);
    const std::size_t when = random() % 6;
    ProcessOptions options;
    options.meanwhile = [&](pid_t process) {
      if (working().empty() || finished() < when) return false;
      kill(process, SIGKILL);
      for (const pid_t task : working()) kill(task, SIGKILL);
      return true;
    };
    const ProcessResult killed = with_tasks(options);
    EXPECT_TRUE(killed.exit_code == 128 + SIGKILL || killed.exit_code == 0) << killed.exit_code;
    ProcessResult resumed;
    // The system may still be terminating them.
    for (int attempt = 0; attempt < 50; ++attempt) {
      resumed = run_qsmpc({"campaign", "resume", out, "--quiet"});
      if (resumed.exit_code != 3) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    ASSERT_EQ(resumed.exit_code, 0) << resumed.errors;
    expect_whole();
  }
}

TEST_F(Cluster, ctrl_c_stops_the_tasks_and_resume_continues) {
  drive_whole(20);
  ProcessOptions options;
  options.meanwhile = [&](pid_t process) {
    if (finished() < 3) return false;
    kill(process, SIGINT);
    return true;
  };
  const ProcessResult stopped = with_tasks(options);
  EXPECT_EQ(stopped.exit_code, 130);
  EXPECT_THAT(stopped.errors, AllOf(HasSubstr("episodes are missing"), HasSubstr("resume")));
  EXPECT_TRUE(working().empty());
  const auto json = nlohmann::json::parse(testing::read_text(out + "/campaign.json"));
  EXPECT_GE(json["done"], 12);
  EXPECT_LT(json["done"], 40);
  const ProcessResult resumed = run_qsmpc({"campaign", "resume", out, "--quiet"});
  ASSERT_EQ(resumed.exit_code, 0) << resumed.errors;
  expect_whole();
}

TEST_F(Cluster, cancelled_from_elsewhere_and_resumed_it_is_whole) {
  drive_whole(120);  // far from complete when the tasks receive the signal
  ProcessOptions options;
  options.meanwhile = [&](pid_t) {
    if (finished() < 3) return false;
    EXPECT_EQ(run_qsmpc({"campaign", "cancel", out}).exit_code, 0);
    return true;
  };
  EXPECT_EQ(with_tasks(options).exit_code, 130);
  EXPECT_LT(finished(), 60);
  const ProcessResult resumed = run_qsmpc({"campaign", "resume", out, "--quiet"});
  ASSERT_EQ(resumed.exit_code, 0) << resumed.errors;
  expect_whole();
}

TEST_F(Cluster, its_status_can_be_read_while_it_runs_and_after) {
  file = testing::short_campaign(folder, 20);
  ProcessResult during;
  ProcessOptions options;
  options.meanwhile = [&](pid_t) {
    if (working().size() < 3 || finished() < 2) return false;
    during = run_qsmpc({"campaign", "status", out, "--json"});
    return true;
  };
  ASSERT_EQ(with_tasks(options).exit_code, 0);
  ASSERT_EQ(during.exit_code, 0) << during.errors;
  const auto json = nlohmann::json::parse(during.output);
  EXPECT_EQ(json["episodes"], 40);
  EXPECT_GE(json["done"], 8);
  EXPECT_EQ(json["cluster"]["on"], "local");
  EXPECT_EQ(json["cluster"]["launch"], 1);
  const auto& leases = json["cluster"]["leases"];
  EXPECT_EQ(leases["total"], 10);
  EXPECT_EQ(leases["finished"].get<int>() + leases["held"].get<int>() +
                leases["given_back"].get<int>() + leases["free"].get<int>(),
            10);
  ASSERT_EQ(json["cluster"]["tasks"].size(), 3U);
  EXPECT_EQ(json["cluster"]["tasks"][0]["task"], 1);
  EXPECT_EQ(json["cluster"]["tasks"][0]["condition"], "running");
  EXPECT_EQ(json["cluster"]["tasks"][0]["says"], "working");
  const ProcessResult after = run_qsmpc({"campaign", "status", out});
  EXPECT_THAT(after.output, AllOf(HasSubstr("40 of 40"), HasSubstr("10 finished, 0 held"),
                                  HasSubstr("says done")));
}

TEST_F(Cluster, a_full_disk_loses_nothing_that_was_done) {
  drive_whole(24);
  const testing::SmallDisk disk(out, 500);
  plan();
  for (int attempt = 0; attempt < 2; ++attempt) {
    const ProcessResult full = work(1, disk.when_small());
    EXPECT_EQ(full.exit_code, 3) << full.errors;
    EXPECT_EQ(std::ranges::count(full.errors, '\n'), 1) << full.errors;
    EXPECT_THAT(full.errors, HasSubstr(out));
  }
  EXPECT_GT(finished(), 0U);
  EXPECT_LT(finished(), 12U);
  disk.grow();
  const ProcessResult last = work(2);
  EXPECT_EQ(last.exit_code, 0) << last.errors;
  const ProcessResult gathered = gather();
  ASSERT_EQ(gathered.exit_code, 0) << gathered.errors;
  expect_whole();
}

TEST_F(Cluster, a_folder_that_vanishes_ends_the_task_in_one_line_and_loses_nothing) {
  drive_whole(24);
  plan();
  ProcessOptions options;
  options.meanwhile = [&](pid_t) {
    if (finished() < 2) return false;
    fs::rename(out, folder / "gone");
    return true;
  };
  const ProcessResult result = work(1, options);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(std::ranges::count(result.errors, '\n'), 1) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr(out));
  fs::rename(folder / "gone", out);
  EXPECT_EQ(work(2).exit_code, 0);
  ASSERT_EQ(gather().exit_code, 0);
  expect_whole();
}

TEST_F(Cluster, what_is_there_of_it_can_be_gathered) {
  drive_whole(12);
  plan();
  ProcessOptions options;
  options.meanwhile = [&](pid_t process) {
    if (finished() < 2) return false;
    kill(process, SIGKILL);
    return true;
  };
  EXPECT_EQ(work(1, options).exit_code, 128 + SIGKILL);
  const ProcessResult part = run_qsmpc({"campaign", "gather", out});
  EXPECT_EQ(part.exit_code, 130) << part.errors;
  EXPECT_THAT(part.errors, HasSubstr("of 24 episodes are missing"));
  EXPECT_THAT(part.errors, HasSubstr("checking for up to 1 s whether task 1"));
  EXPECT_GE(nlohmann::json::parse(testing::read_text(out + "/campaign.json"))["done"], 8);
  EXPECT_EQ(work(2).exit_code, 0);
  ASSERT_EQ(gather().exit_code, 0);
  expect_whole();
}

TEST_F(Cluster, tasks_stop_where_one_process_stops) {
  drive_whole(400, "until: {of: timeout, rate_halfwidth: 0.2}\n");
  const ProcessResult result = with_tasks();
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  expect_whole();
  EXPECT_LT(finished(), 200U);
  EXPECT_EQ(run_qsmpc({"campaign", "resume", out, "--quiet"}).exit_code, 0);
  expect_whole();
}

TEST_F(Cluster, incompatible_options_are_reported_in_one_line) {
  file = testing::short_campaign(folder, 2);
  const auto expect_refused = [](const ProcessResult& result, const std::string& message) {
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_EQ(std::ranges::count(result.errors, '\n'), 1) << result.errors;
    EXPECT_THAT(result.errors, HasSubstr(message));
  };
  expect_refused(with_tasks({}, {"--shard", "1/2"}), "--shard");
  expect_refused(with_tasks({}, {"--update"}), "--update");
  expect_refused(with_tasks({}, {"--retry-faults"}), "--retry-faults");
  expect_refused(run_qsmpc({"campaign", file, "--tasks", "2", "--out", out}), "--on");
  expect_refused(run_qsmpc({"campaign", file, "--on", "moon", "--out", out}), "moon");
  for (const char* command : {"work", "gather", "resume", "cancel"}) {
    expect_refused(run_qsmpc({"campaign", command, folder.path()}), "plan");
  }
  EXPECT_FALSE(fs::exists(out));
  // One process does not continue what tasks have begun, nor tasks what one process has begun.
  plan();
  expect_refused(run_qsmpc({"campaign", file, "--out", out}), "resume");
  ASSERT_EQ(with_tasks().exit_code, 0);
  expect_refused(with_tasks({}, {"--lease", "1"}), "--lease");
  ASSERT_EQ(run_qsmpc({"campaign", file, "--out", whole, "--quiet"}).exit_code, 0);
  out = whole;
  expect_refused(with_tasks(), "one process");
  out = folder / "out";
  (void)testing::short_campaign(folder, 3);
  expect_refused(with_tasks(), "seeds: found 3 to 4");
}

}  // namespace cluster_test
}  // namespace qsmpc::harness
