// The program's campaigns on a real Slurm and behind a real sshd: the same rows and statistics as
// from one process, whichever processes die.
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cluster/slurm_cluster.hpp"
#include "tests/integration/campaign_fixture.hpp"
#include "tests/integration/process.hpp"
#include "tests/support/processes.hpp"

namespace qsmpc::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

/// Mostly waits, so that its duration does not depend on the machine's load and it uses no cores.
constexpr const char* kSlowController = R"(while read -r line; do
  case $line in
    *'"scenario"'*) echo '{"protocol": 1}' ;;
    *'"situation"'*) sleep 0.3; echo '{"input": [0.3]}' ;;
  esac
done
)";

/// A campaign of `seeds` drives of three seconds and as many short ones.
std::string slow_campaign(const TemporaryFolder& folder, int seeds) {
  (void)folder.file("slow.sh", kSlowController);
  return folder.file("slow.yaml",
                     fmt::format("name: slow\n"
                                 "scenario: dubins_corridor\n"
                                 "variants:\n"
                                 "  slow: {{controller.kind: external, "
                                 "controller.command: [sh, {}]}}\n"
                                 "  quick: {{controller.kind: lqr}}\n"
                                 "grid: {{plant.kind: [analytic], limit.steps: [10]}}\n"
                                 "seeds: {{first: 3, count: {}}}\n",
                                 folder / "slow.sh", seeds));
}

/// Runs the campaign in one process, into the folder "one".
void drive_alone(const TemporaryFolder& folder, const std::string& campaign) {
  const ProcessResult result =
      run_qsmpc({"campaign", campaign, "--jobs", "80", "--quiet", "--out", folder / "one"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
}

void expect_same_results(const TemporaryFolder& folder, const std::string& other) {
  EXPECT_EQ(rows_of(other), rows_of(folder / "one"));
  EXPECT_EQ(results_of(other), results_of(folder / "one"));
  EXPECT_TRUE(std::filesystem::exists(other + "/report.html"));
}

std::size_t finished_leases(const std::string& folder) {
  return files_in(folder + "/cluster/finished").size();
}

std::string slurm_job_of(const std::string& folder) {
  const auto launch = nlohmann::json::parse(text_of(folder + "/cluster/launch.json"));
  return nlohmann::json::parse(launch.at("record").get<std::string>()).at("job");
}

/// The tasks of the job in this state, on `node` if one is given.
std::vector<std::string> tasks_in(const std::string& job, const std::string& state,
                                  const std::string& node = "") {
  std::vector<std::string> words{"squeue",
                                 "--noheader",
                                 "--array",
                                 "--jobs",
                                 job,
                                 "--states=" + state,
                                 "--Format=ArrayTaskID:"};
  if (!node.empty()) words.push_back("--nodelist=" + node);
  std::istringstream lines(slurm_command(words));
  std::vector<std::string> tasks;
  for (std::string task; lines >> task;) tasks.push_back(task);
  return tasks;
}

// Enough to keep the campaign running until the lost node has been detected and is back, after 40
// s.
constexpr int kSeeds = 240;

TEST(SlurmProgram, drives_what_one_process_does_whatever_dies) {
  const TemporaryFolder folder;
  const std::string campaign = slow_campaign(folder, kSeeds);
  const std::string shared = folder / "shared";
  const ProcessResult submitted =
      run_qsmpc({"campaign", campaign, "--on", "slurm", "--tasks", "20", "--jobs", "1", "--lease",
                 "1", "--lost-after", "10", "--out", shared});
  ASSERT_EQ(submitted.exit_code, 0) << submitted.errors;
  const std::string job = slurm_job_of(shared);
  ASSERT_TRUE(soon([&] { return finished_leases(shared) >= 20; }, 60));
  ASSERT_THAT(tasks_in(job, "RUNNING", "n1"), SizeIs(10));
  ASSERT_THAT(tasks_in(job, "RUNNING", "n2"), SizeIs(10));

  // One node dies; on the other node, one task is requeued and one is cancelled.
  kill_node("n2");
  const std::vector<std::string> others = tasks_in(job, "RUNNING", "n1");
  slurm_command({"scontrol", "requeue", job + "_" + others.at(0)});
  slurm_command({"scancel", job + "_" + others.at(1)});
  EXPECT_TRUE(soon([&] { return tasks_in(job, "PENDING").size() >= 10; }, 60));
  start_node("n2");
  EXPECT_TRUE(soon([&] { return tasks_in(job, "RUNNING").size() >= 15; }, 60));
  const ProcessResult status = run_qsmpc({"campaign", "status", shared});
  EXPECT_EQ(status.exit_code, 0) << status.errors;
  EXPECT_THAT(status.output, HasSubstr("CANCELLED"));

  // All tasks are cancelled midway, and others drive the missing episodes.
  EXPECT_EQ(run_qsmpc({"campaign", "cancel", shared}).exit_code, 0);
  EXPECT_TRUE(soon([] { return slurm_command({"squeue", "--noheader"}).empty(); }));
  EXPECT_LT(finished_leases(shared), std::size_t{kSeeds});
  const ProcessResult resumed = run_qsmpc({"campaign", "resume", shared});
  ASSERT_EQ(resumed.exit_code, 0) << resumed.errors;
  drive_alone(folder, campaign);
  EXPECT_TRUE(soon([] { return slurm_command({"squeue", "--noheader"}).empty(); }, 120));
  expect_same_results(folder, shared);
}

TEST(SshProgram, drives_what_one_process_does_on_hosts_of_which_one_is_not_there) {
  const char* const config = std::getenv("SSHD_HERE_CONFIG");
  if (config == nullptr) throw std::runtime_error("to be run by tests/cluster/sshd_here");
  const TemporaryFolder folder;
  const std::string campaign = slow_campaign(folder, 20);
  drive_alone(folder, campaign);
  const std::string shared = folder / "shared";
  const ProcessResult result =
      run_qsmpc({"campaign", campaign, "--on", "ssh:2/one,nowhere,two", "--program", QSMPC_PROGRAM,
                 "--ssh-config", config, "--jobs", "2", "--lease", "1", "--out", shared});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("task 3 lost on nowhere"));
  expect_same_results(folder, shared);
}

}  // namespace
}  // namespace qsmpc::testing
