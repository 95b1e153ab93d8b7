// A job array on a real two-node Slurm cluster, which slurm_here starts.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/cluster/launch/launch_record.hpp"
#include "harness/cluster/launch/launcher.hpp"
#include "tests/cluster/slurm_cluster.hpp"
#include "tests/support/processes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::testing {
namespace {

using harness::TaskCondition;
using harness::TaskState;
using ::testing::HasSubstr;

class Slurm : public ::testing::Test {
 protected:
  [[nodiscard]] std::string start(const std::string& worker, const std::string& gather, int tasks,
                                  const harness::LaunchOptions& options = {.on = "slurm"}) const {
    return harness::make_launcher(options)->start({.folder = folder.path(),
                                                   .worker = {"sh", "-c", worker, "sh"},
                                                   .gather = {"sh", "-c", gather},
                                                   .tasks = tasks});
  }
  static std::vector<TaskState> states(const std::string& record) {
    return harness::launcher_of(record)->states(record);
  }
  static bool all_are(const std::string& record, TaskCondition condition) {
    return std::ranges::all_of(states(record), [condition](const TaskState& state) {
      return state.condition == condition;
    });
  }
  [[nodiscard]] bool has(const std::string& name) const {
    return std::filesystem::exists(folder / name);
  }
  [[nodiscard]] std::string log(int task) const {
    return text_of(harness::task_log_path(folder.path(), task));
  }

  TemporaryFolder folder;
};

TEST_F(Slurm, runs_an_array_and_then_what_depends_on_it) {
  const std::string lines = folder.file("lines", "#SBATCH --comment=hello\n");
  const std::string record = start(
      "echo \"$2 of $SLURM_ARRAY_TASK_COUNT on $SLURM_CPUS_PER_TASK in $PWD\"; test $2 != 2 || "
      "exit 3",
      "ls cluster/ends/*/[0-9]* >gathered", 4,
      {.on = "slurm",
       .tasks_at_once = 3,
       .partition = "main",
       .time = "10",
       .sbatch_lines = harness::read_sbatch_lines(lines)});
  ASSERT_TRUE(soon([&] { return !text_of(folder / "gathered").empty(); }));
  EXPECT_EQ(log(1), "1 of 4 on 1 in " + folder.path() + "\n");
  const std::string gathered = text_of(folder / "gathered");
  EXPECT_EQ(std::ranges::count(gathered, '\n'), 4);
  const auto ended = states(record);
  ASSERT_EQ(ended.size(), 4U);
  EXPECT_EQ(ended[0].condition, TaskCondition::kDone);
  EXPECT_EQ(ended[1].condition, TaskCondition::kFailed);
  EXPECT_THAT(ended[1].note, HasSubstr("exit code 3"));
  EXPECT_THAT(ended[1].where, HasSubstr("n"));
}

TEST_F(Slurm, cancels_what_runs_what_waits_and_what_depends_on_them) {
  // Until Slurm has noticed that the script is running, it does not pass on signals; it then kills
  // the script without warning.
  const std::string record =
      start("trap 'echo told; exit 130' TERM; sleep 1; : >ready; sleep 600 & wait", ": >gathered",
            3, {.on = "slurm", .tasks_at_once = 1});
  ASSERT_TRUE(soon([&] { return has("ready"); }));
  EXPECT_FALSE(all_are(record, TaskCondition::kRunning));
  harness::launcher_of(record)->cancel(record);
  EXPECT_TRUE(soon([&] { return all_are(record, TaskCondition::kCancelled); }));
  EXPECT_TRUE(soon([&] { return log(1).find("told") != std::string::npos; }));
  EXPECT_TRUE(soon([&] { return slurm_command({"squeue", "--noheader"}).empty(); }));
  EXPECT_FALSE(has("gathered"));
}

TEST_F(Slurm, warns_workers_before_their_time_is_over) {
  // Slurm takes times in whole minutes, checks every 30 s which jobs to warn, and warns those that
  // end before its next check: with a limit of one minute that may be before the script's first
  // line.
  const std::string record =
      start("trap 'exit 130' TERM; sleep 600 & wait", "true", 1, {.on = "slurm", .time = "2"});
  ASSERT_TRUE(soon(
      [&] {
        // Queried once: a waiting task may start between two queries.
        const TaskCondition now = states(record).front().condition;
        return now != TaskCondition::kRunning && now != TaskCondition::kWaiting;
      },
      90));
  const auto end = harness::read_task_end(harness::launch_record_of(record), 1);
  ASSERT_TRUE(end.has_value());
  EXPECT_EQ(end->condition, TaskCondition::kCancelled);
}

TEST_F(Slurm, starts_a_requeued_task_again) {
  const std::string record =
      start("echo \"run ${SLURM_RESTART_COUNT:-0}\"; : >ready; until [ -e go ]; do sleep 0.1; done",
            "true", 1);
  ASSERT_TRUE(soon([&] { return has("ready"); }));
  slurm_command({"scontrol", "requeue", harness::launch_record_of(record).job + "_1"});
  EXPECT_TRUE(soon([&] { return log(1).find("run 1") != std::string::npos; }));
  (void)folder.file("go", "");
  EXPECT_TRUE(soon([&] { return all_are(record, TaskCondition::kDone); }));
  EXPECT_THAT(states(record).front().note, HasSubstr("restarts: 1"));
}

TEST_F(Slurm, starts_tasks_of_a_node_that_died_again) {
  const std::string record =
      start("echo \"run ${SLURM_RESTART_COUNT:-0}\"; until [ -e go ]; do sleep 0.1; done",
            ": >gathered", 2, {.on = "slurm", .sbatch_lines = {"#SBATCH --nodelist=n2"}});
  ASSERT_TRUE(soon([&] { return !log(1).empty() && !log(2).empty(); }));
  kill_node("n2");
  EXPECT_TRUE(soon([&] { return all_are(record, TaskCondition::kWaiting); }, 60));
  start_node("n2");
  (void)folder.file("go", "");
  EXPECT_TRUE(soon([&] { return all_are(record, TaskCondition::kDone); }, 60));
  EXPECT_EQ(log(2), "run 0\nrun 1\n");
  EXPECT_TRUE(soon([&] { return has("gathered"); }));
}

}  // namespace
}  // namespace qsmpc::testing
