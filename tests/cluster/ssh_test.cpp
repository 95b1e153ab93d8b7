// Workers behind a real sshd, which sshd_here starts.
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/cluster/launch/launcher.hpp"
#include "tests/support/processes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::testing {
namespace {

using harness::LaunchRequest;
using harness::TaskCondition;
using ::testing::HasSubstr;

class Ssh : public ::testing::Test {
 protected:
  static harness::LaunchOptions options(const std::string& hosts) {
    const char* const config = std::getenv("SSHD_HERE_CONFIG");
    if (config == nullptr) throw std::runtime_error("to be run by tests/cluster/sshd_here");
    return {.on = "ssh:" + hosts, .program = "sh", .ssh_config = config};
  }
  [[nodiscard]] LaunchRequest request(const std::string& script, int tasks) const {
    return {.folder = folder.path(), .worker = {"here", "-c", script, "sh"}, .tasks = tasks};
  }
  [[nodiscard]] bool has(const std::string& name) const {
    return std::filesystem::exists(folder / name);
  }

  TemporaryFolder folder;
};

TEST_F(Ssh, runs_workers_on_all_hosts_but_those_it_cannot_reach) {
  const std::string hosts = folder.file("hosts", "2/one\nnowhere # nobody listens\ntwo\n");
  const auto launcher = harness::make_launcher(options("@" + hosts));
  LaunchRequest all = request("printf '<%s>' \"$0\" \"$@\" \"$(readlink /proc/self/fd/0)\"", 4);
  all.worker.insert(all.worker.end(), {"it's", "$HOME \"x\" \\", ""});
  const std::string record = launcher->start(all);
  launcher->wait(record, [] { return true; });
  const auto states = harness::launcher_of(record)->states(record);
  ASSERT_EQ(states.size(), 4U);
  for (const int task : {1, 2, 4}) {
    EXPECT_EQ(states[task - 1].condition, TaskCondition::kDone) << states[task - 1].note;
    EXPECT_EQ(text_of(harness::task_log_path(folder.path(), task)),
              "<sh><it's><$HOME \"x\" \\><><--task><" + std::to_string(task) + "></dev/null>");
  }
  EXPECT_EQ(states[2].condition, TaskCondition::kLost);
  EXPECT_EQ(states[2].where, "nowhere");
  EXPECT_THAT(states[2].note, HasSubstr("Connection refused"));
}

TEST_F(Ssh, ends_workers_and_their_children_on_cancel) {
  const auto launcher = harness::make_launcher(options("one"));
  const std::string record =
      launcher->start(request("trap 'exit 130' TERM; sleep 600 & echo $! >'" + (folder / "child") +
                                  "'; : >'" + (folder / "ready") + "'; wait",
                              1));
  bool cancelled = false;
  launcher->wait(record, [&] {
    if (!cancelled && has("ready")) {
      cancelled = true;
      harness::launcher_of(record)->cancel(record);
    }
    return true;
  });
  EXPECT_EQ(launcher->states(record).front().condition, TaskCondition::kCancelled);
  EXPECT_TRUE(soon([&] { return !is_process(word_of(folder / "child")); }));
}

TEST_F(Ssh, leaves_no_worker_when_the_process_that_started_it_is_killed) {
  const pid_t conductor = fork();
  ASSERT_GE(conductor, 0);
  if (conductor == 0) {
    const auto launcher = harness::make_launcher(options("one"));
    const std::string record = launcher->start(request(
        "echo $$ >'" + (folder / "worker") + "'; : >'" + (folder / "ready") + "'; exec sleep 600",
        1));
    launcher->wait(record, [] { return true; });
    _exit(0);
  }
  const bool started = soon([&] { return has("ready"); });
  kill(conductor, SIGKILL);
  waitpid(conductor, nullptr, 0);
  ASSERT_TRUE(started);
  EXPECT_TRUE(soon([&] { return !is_process(word_of(folder / "worker")); }));
}

/// Kills the ssh client to `host`.
void kill_client(const std::string& host) {
  const std::string own = std::to_string(getpid());
  std::ifstream children("/proc/self/task/" + own + "/children");
  for (std::string child; children >> child;) {
    const std::string words = text_of("/proc/" + child + "/cmdline");
    const std::string host_word = std::string("--") + '\0' + host + '\0';
    if (words.find(host_word) != std::string::npos) kill(std::stoi(child), SIGKILL);
  }
}

TEST_F(Ssh, loses_a_worker_whose_connection_dies_and_continues_with_the_others) {
  const auto launcher = harness::make_launcher(options("one,two"));
  const std::string record = launcher->start(request(
      "test $2 = 1 && { echo $$ >'" + (folder / "worker") + "'; : >'" + (folder / "ready") +
          "'; exec sleep 600; }; until [ -e '" + (folder / "go") + "' ]; do sleep 0.05; done",
      2));
  bool killed = false;
  launcher->wait(record, [&] {
    if (!killed && has("ready")) {
      killed = true;
      kill_client("one");
    }
    if (killed && !is_process(word_of(folder / "worker"))) (void)folder.file("go", "");
    return true;
  });
  const auto states = launcher->states(record);
  EXPECT_EQ(states[0].condition, TaskCondition::kFailed);
  EXPECT_THAT(states[0].note, HasSubstr("signal 9"));
  EXPECT_EQ(states[1].condition, TaskCondition::kDone);
}

}  // namespace
}  // namespace qsmpc::testing
