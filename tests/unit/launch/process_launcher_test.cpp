#include "harness/cluster/launch/process_launcher.hpp"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/cluster/launch/command.hpp"
#include "harness/cluster/launch/launch_record.hpp"
#include "harness/cluster/launch/shell_words.hpp"
#include "tests/support/processes.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/launch/fake_programs.hpp"

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;
using qsmpc::testing::is_process;
using qsmpc::testing::soon;
using qsmpc::testing::text_of;
using qsmpc::testing::word_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class LocalLauncher : public ::testing::Test {
 protected:
  /// A worker that is this script; its arguments are in $@.
  [[nodiscard]] LaunchRequest request(const std::string& script, int tasks) const {
    return {.folder = folder.path(), .worker = {"sh", "-c", script, "sh"}, .tasks = tasks};
  }
  [[nodiscard]] std::string log(int task) const {
    return text_of(task_log_path(folder.path(), task));
  }
  [[nodiscard]] bool has(const std::string& name) const { return fs::exists(folder / name); }

  qsmpc::testing::TemporaryFolder folder;
};

TEST_F(LocalLauncher, runs_every_task_and_reports_how_each_ended) {
  const auto launcher = make_launcher({.on = "local", .tasks = 3});
  const std::string record =
      launcher->start(request("echo task $2 $(readlink /proc/self/fd/0); echo 'last words' >&2; "
                              "test $2 = 1 || { test $2 = 2 && exit 5; kill -KILL $$; }",
                              3));
  launcher->wait(record, [] { return true; });
  const auto states = launcher_of(record)->states(record);
  ASSERT_EQ(states.size(), 3U);
  EXPECT_EQ(states[0].condition, TaskCondition::kDone);
  EXPECT_EQ(states[1].condition, TaskCondition::kFailed);
  EXPECT_EQ(states[1].note, "exit code 5: last words");
  EXPECT_EQ(states[2].note, "ended by signal 9 (Killed)");
  EXPECT_EQ(states[2].where, this_process().host);
  EXPECT_EQ(log(2), "task 2 /dev/null\nlast words\n");
}

TEST_F(LocalLauncher, appends_to_the_log_of_an_earlier_launch) {
  for (int launch = 0; launch < 2; ++launch) {
    const auto launcher = make_launcher({.on = "local"});
    const std::string record = launcher->start(request("echo hello", 1));
    EXPECT_NE(launcher->states(record).front().condition, TaskCondition::kLost);
    launcher->wait(record, [] { return true; });
  }
  EXPECT_EQ(log(1), "hello\nhello\n");
}

TEST_F(LocalLauncher, sends_sigterm_each_time_that_it_is_asked_to_stop) {
  const auto launcher = make_launcher({.on = "local"});
  const std::string record = launcher->start(
      request("n=0; trap 'n=$((n + 1)); : >\"" + folder.path() + "/heard$n\"' TERM; : >'" +
                  folder.path() + "/ready'; while [ $n -lt 2 ]; do sleep 0.05; done; exit 130",
              1));
  int asked = 0;
  launcher->wait(record, [&] {
    const bool first = asked == 0 && has("ready");
    const bool second = asked == 1 && has("heard1");
    if (first || second) ++asked;
    return !first && !second;
  });
  EXPECT_EQ(asked, 2);
  const TaskState state = launcher->states(record).front();
  EXPECT_EQ(state.condition, TaskCondition::kCancelled);
  EXPECT_THAT(state.note, StartsWith("exit code 130"));
}

TEST_F(LocalLauncher, ends_workers_with_their_children_when_another_process_cancels) {
  const auto launcher = make_launcher({.on = "local"});
  const std::string record = launcher->start(request(
      "sleep 600 & echo $! >'" + (folder / "child") + "'; : >'" + (folder / "ready") + "'; wait",
      1));
  bool cancelled = false;
  launcher->wait(record, [&] {
    if (!cancelled && has("ready")) {
      cancelled = true;
      launcher_of(record)->cancel(record);
    }
    return true;
  });
  EXPECT_EQ(launcher->states(record).front().condition, TaskCondition::kCancelled);
  const std::string child = word_of(folder / "child");
  EXPECT_TRUE(soon([&] { return !is_process(child); }));
}

TEST_F(LocalLauncher, leaves_no_worker_when_the_process_that_started_it_is_killed) {
  const pid_t conductor = fork();
  ASSERT_GE(conductor, 0);
  if (conductor == 0) {
    const auto launcher = make_launcher({.on = "local"});
    const std::string record = launcher->start(request(
        "echo $$ >'" + (folder / "worker") + "'; : >'" + (folder / "ready") + "'; exec sleep 600",
        1));
    std::ofstream(folder / "record") << record << std::flush;
    launcher->wait(record, [] { return true; });
    _exit(0);
  }
  ASSERT_TRUE(soon([&] { return has("ready") && !text_of(folder / "record").empty(); }));
  const std::string record = text_of(folder / "record");
  EXPECT_EQ(launcher_of(record)->states(record).front().condition, TaskCondition::kRunning);
  kill(conductor, SIGKILL);
  waitpid(conductor, nullptr, 0);
  const std::string worker = word_of(folder / "worker");
  EXPECT_TRUE(soon([&] { return !is_process(worker); }));
  const TaskState state = launcher_of(record)->states(record).front();
  EXPECT_EQ(state.condition, TaskCondition::kLost);
  EXPECT_THAT(state.note, HasSubstr("the process that started it has ended"));
}

TEST_F(LocalLauncher, knows_nothing_about_processes_of_another_machine) {
  LaunchRecord record{.kind = "local",
                      .launch = "first",
                      .folder = folder.path(),
                      .tasks = 1,
                      .where = {"far"},
                      .conductor = this_process()};
  record.conductor.host = "far";
  const std::string text = launch_record_text(record);
  EXPECT_EQ(launcher_of(text)->states(text).front().condition, TaskCondition::kRunning);
  record.conductor = this_process();
  record.conductor.started += 1;  // the process id now belongs to another process
  EXPECT_EQ(fate_of(record.conductor), ProcessFate::kGone);
}

TEST(SshLauncher, loses_a_host_that_fails_and_continues_with_the_others) {
  const qsmpc::testing::TemporaryFolder folder;
  const qsmpc::testing::FakePrograms fakes;
  // Like ssh: the words after the host are passed to a shell there.
  fakes.add("ssh",
            "while [ \"$1\" != -- ]; do shift; done; "
            "case $2 in bad) echo 'ssh: connect to host bad port 22: Connection refused' >&2; exit "
            "255 ;; esac; "
            "exec sh -c \"$3\"");
  const auto launcher = make_launcher({.on = "ssh:2/good:2222,bad", .program = "sh"});
  const std::string record = launcher->start(
      {.folder = folder.path(),
       .worker = {"not sh", "-c", "printf '<%s>' \"$@\"", "sh", "it's", "$HOME \"x\"", ""},
       .tasks = 3});
  launcher->wait(record, [] { return true; });
  EXPECT_THAT(
      launcher->states(record),
      ElementsAre(TaskState{.task = 1, .condition = TaskCondition::kDone, .where = "good"},
                  TaskState{.task = 2, .condition = TaskCondition::kDone, .where = "good"},
                  TaskState{.task = 3,
                            .condition = TaskCondition::kLost,
                            .where = "bad",
                            .note = "ssh: connect to host bad port 22: Connection refused"}));
  EXPECT_EQ(text_of(task_log_path(folder.path(), 2)), "<it's><$HOME \"x\"><><--task><2>");
  EXPECT_THAT(fakes.calls(), HasSubstr("-o BatchMode=yes"));
  EXPECT_THAT(fakes.calls(), HasSubstr("-p 2222 -- good exec sh -c "));
}

TEST(ShellCommand, is_split_into_the_same_words) {
  const std::vector<std::string> words{"plain",           "two words", "it's", "",
                                       "$x `y` \\ \"z\"", "a;b",       "*"};
  EXPECT_EQ(run_command({"sh", "-c", "printf '%s|' " + shell_command(words)}).output,
            "plain|two words|it's||$x `y` \\ \"z\"|a;b|*|");
}

TEST(Commands, that_do_not_end_are_killed) {
  EXPECT_THROW((void)run_command({"sleep", "600"}, std::chrono::milliseconds(100)),
               std::runtime_error);
  EXPECT_THROW((void)run_command({"/nowhere/program"}), std::runtime_error);
  EXPECT_EQ(run_command({"sh", "-c", "echo out; echo err >&2; kill -KILL $$"}).exit_code, 137);
}

}  // namespace
}  // namespace qsmpc::harness
