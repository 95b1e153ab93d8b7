#include "harness/cluster/launch/slurm_script.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/cluster/launch/command.hpp"
#include "harness/cluster/launch/launch_record.hpp"
#include "harness/errors.hpp"
#include "tests/support/processes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST(SlurmScript, contains_the_options_of_sbatch) {
  const LaunchRequest request{
      .folder = "/shared/my 50% run",
      .worker = {"/usr/bin/qsmpc", "campaign", "work", "/shared/my 50% run"},
      .gather = {"/usr/bin/qsmpc", "campaign", "gather", "/shared/my 50% run"},
      .tasks = 20,
      .jobs = 4};
  const LaunchOptions options{.on = "slurm",
                              .tasks_at_once = 5,
                              .partition = "long",
                              .time = "2:00:00",
                              .account = "me",
                              .sbatch_lines = {"#SBATCH --mem=4G"}};
  const std::string script = worker_script(request, options, "first");
  EXPECT_THAT(script, StartsWith("#!/bin/bash\n"));
  for (const char* const line :
       {"#SBATCH --array=1-20%5\n", "#SBATCH --cpus-per-task=4\n", "#SBATCH --signal=B:TERM@60\n",
        "#SBATCH --job-name=qsmpc-my_50__run\n", "#SBATCH --chdir=\"/shared/my 50% run\"\n",
        "#SBATCH --output=\"/shared/my 50%% run/cluster/log/%a.out\"\n",
        "#SBATCH --open-mode=append\n", "#SBATCH --requeue\n", "#SBATCH --partition=long\n",
        "#SBATCH --time=2:00:00\n", "#SBATCH --account=me\n", "#SBATCH --mem=4G\n",
        "\n/usr/bin/qsmpc campaign work '/shared/my 50% run' --task \"$SLURM_ARRAY_TASK_ID\""}) {
    EXPECT_THAT(script, HasSubstr(line));
  }
  const std::string gather = gather_script(request, options);
  EXPECT_THAT(gather, HasSubstr("cluster/log/gather.out"));
  EXPECT_THAT(gather, HasSubstr("\nexec /usr/bin/qsmpc campaign gather '/shared/my 50% run'\n"));
  EXPECT_THAT(gather, Not(HasSubstr("--array")));
  EXPECT_THAT(worker_script(request, {.on = "slurm", .program = "/opt/in box"}, "first"),
              HasSubstr("\n'/opt/in box' campaign work"));
}

TEST(SlurmScript, is_refused_for_folders_that_slurm_cannot_name) {
  for (const char* const folder : {"/a\"b", "/a\\b", "/a\nb"}) {
    EXPECT_THROW((void)worker_script({.folder = folder, .worker = {"x"}}, {.on = "slurm"}, "first"),
                 InputError);
  }
}

/// Runs the script of a worker `sh -c SHELL` for task 3; returns the contents of its end file.
std::string end_of_script(const std::string& shell, int expected_exit,
                          const std::string& meanwhile = ":", const std::string& before = ":") {
  const qsmpc::testing::TemporaryFolder folder;
  const std::string launch = begin_launch(folder.path());
  const std::string script = folder.file(
      "script", worker_script({.folder = folder.path(), .worker = {"sh", "-c", shell, "sh"}},
                              {.on = "slurm"}, launch));
  const CommandResult result =
      run_command({"bash", "-c",
                   "cd '" + folder.path() + "' && " + before +
                       "; export SLURM_ARRAY_TASK_ID=3; bash script & job=$!; " + meanwhile +
                       "; wait \"$job\""});
  EXPECT_EQ(result.exit_code, expected_exit) << result.errors;
  return qsmpc::testing::text_of(ends_folder(folder.path(), launch) + "/3");
}

TEST(SlurmScript, leaves_how_the_worker_ended) {
  EXPECT_EQ(end_of_script("exit 0", 0), "done\n");
  EXPECT_EQ(end_of_script("test \"$*\" = '--task 3' || exit 9; exit 4", 4), "failed exit code 4\n");
  EXPECT_EQ(end_of_script("exit 130", 130), "cancelled exit code 130\n");
}

TEST(SlurmScript, passes_sigterm_on_and_waits_for_the_worker) {
  // The worker needs a while to end after the request.
  EXPECT_EQ(end_of_script("trap 'sleep 0.2; exit 130' TERM; : >ready; while :; do sleep 0.05; done",
                          130, "until [ -e ready ]; do sleep 0.02; done; kill -s TERM \"$job\""),
            "cancelled exit code 130\n");
}

TEST(SlurmScript, passes_a_sigterm_on_that_comes_before_the_worker_runs) {
  // The script calls `rm` before it starts the worker, which would sleep for a minute.
  EXPECT_EQ(end_of_script("exec sleep 60", 143, ":",
                          "printf '#!/bin/sh\\nkill -s TERM \"$PPID\"\\n' >rm && chmod +x rm && "
                          "PATH=$PWD:$PATH"),
            "cancelled exit code 143\n");
}

}  // namespace
}  // namespace qsmpc::harness
