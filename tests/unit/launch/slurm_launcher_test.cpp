#include "harness/cluster/launch/slurm_launcher.hpp"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/cluster/launch/launch_record.hpp"
#include "harness/errors.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/launch/fake_programs.hpp"

namespace qsmpc::harness {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

class SlurmLauncherWithFakes : public ::testing::Test {
 protected:
  SlurmLauncherWithFakes() {
    fakes.add("sbatch", "case \"$*\" in *--dependency*) echo '18;west' ;; *) echo 17 ;; esac");
    fakes.add("scancel", "");
  }
  [[nodiscard]] LaunchRequest request(int tasks) const {
    return {.folder = folder.path(), .worker = {"w"}, .gather = {"g"}, .tasks = tasks};
  }
  /// The message of the IoError that `call` throws.
  template <class Call>
  static std::string io_error_of(const Call& call) {
    try {
      call();
    } catch (const IoError& error) {
      return error.what();
    }
    return {};
  }

  qsmpc::testing::TemporaryFolder folder;
  qsmpc::testing::FakePrograms fakes;
  SlurmLauncher launcher{{.on = "slurm"}};
};

TEST_F(SlurmLauncherWithFakes, submits_the_array_and_what_depends_on_it) {
  const std::string text = launcher.start(request(4));
  EXPECT_THAT(fakes.calls(),
              MatchesRegex("sbatch --parsable [^\n]*/cluster/slurm/[^\n]*[.]sh\n"
                           "sbatch --parsable --dependency=afterany:17 [^\n]*-gather[.]sh\n"));
  const LaunchRecord record = launch_record_of(text);
  EXPECT_EQ(record.job, "17");
  EXPECT_EQ(record.gather_job, "18");
  EXPECT_EQ(record.tasks, 4);
  EXPECT_THAT(text, Not(HasSubstr("\n")));
}

TEST_F(SlurmLauncherWithFakes, leaves_no_array_that_nobody_knows_of) {
  fakes.add("sbatch", "case \"$*\" in *--dependency*) echo no >&2; exit 1 ;; *) echo 17 ;; esac");
  EXPECT_THAT(io_error_of([&] { (void)launcher.start(request(4)); }), HasSubstr("exit code 1: no"));
  EXPECT_THAT(fakes.calls(), HasSubstr("scancel 17\n"));
}

TEST_F(SlurmLauncherWithFakes, reports_the_last_lines_of_a_command_that_fails) {
  fakes.add("sbatch", "echo first >&2; echo 'sbatch: error: invalid partition' >&2; exit 1");
  EXPECT_THAT(io_error_of([&] { (void)launcher.start(request(1)); }),
              MatchesRegex("sbatch --parsable .*: exit code 1: sbatch: error: invalid partition"));
  fakes.add("sbatch", "echo Submitted");
  EXPECT_THAT(io_error_of([&] { (void)launcher.start(request(1)); }), HasSubstr("found Submitted"));
}

TEST_F(SlurmLauncherWithFakes, joins_what_slurm_knows_with_what_tasks_left) {
  const std::string text = launcher.start(request(5));
  const LaunchRecord record = launch_record_of(text);
  write_task_end(record, {.task = 2, .condition = TaskCondition::kFailed, .note = "exit code 3"});
  write_task_end(record, {.task = 4, .condition = TaskCondition::kDone});
  fakes.add("squeue",
            "echo '3|PENDING||BeginTime|2|'; echo '1|RUNNING|n1|None|0|'; "
            "echo '2|FAILED|n2|NonZeroExitCode|0|'");
  EXPECT_THAT(
      launcher.states(text),
      ElementsAre(
          TaskState{
              .task = 1, .condition = TaskCondition::kRunning, .where = "n1", .note = "RUNNING"},
          TaskState{.task = 2,
                    .condition = TaskCondition::kFailed,
                    .where = "n2",
                    .note = "FAILED (NonZeroExitCode), exit code 3"},
          TaskState{.task = 3,
                    .condition = TaskCondition::kWaiting,
                    .note = "PENDING (BeginTime), restarts: 2"},
          TaskState{.task = 4, .condition = TaskCondition::kDone},
          TaskState{.task = 5,
                    .condition = TaskCondition::kLost,
                    .note = "Slurm no longer knows job 17_5, and it left no record of its end"}));
  EXPECT_THAT(fakes.calls(), HasSubstr("--jobs 17 "));
}

TEST_F(SlurmLauncherWithFakes,
       says_it_where_slurm_has_forgotten_the_job_and_fails_where_it_is_not_there) {
  const std::string text = launcher.start(request(1));
  fakes.add("squeue", "echo 'slurm_load_jobs error: Invalid job id specified' >&2; exit 1");
  EXPECT_EQ(launcher.states(text).front().condition, TaskCondition::kLost);
  fakes.add("squeue",
            "echo 'slurm_load_jobs error: Unable to contact slurm controller' >&2; exit 1");
  EXPECT_THAT(io_error_of([&] { (void)launcher.states(text); }), HasSubstr("Unable to contact"));
  fakes.add("squeue", "echo 'JOBID PARTITION'");
  EXPECT_THAT(io_error_of([&] { (void)launcher.states(text); }),
              HasSubstr("found JOBID PARTITION"));
}

TEST_F(SlurmLauncherWithFakes, cancels_the_dependent_job_first) {
  const std::string text = launcher.start(request(2));
  fakes.add("squeue", "exit 0");
  launcher.cancel(text);
  EXPECT_THAT(fakes.calls(), HasSubstr("scancel 18\nscancel 17\n"));
  EXPECT_EQ(launcher.states(text).back().condition, TaskCondition::kCancelled);
  fakes.add("scancel", "echo 'scancel: error: Invalid job id 17' >&2; exit 1");
  EXPECT_NO_THROW(launcher.cancel(text));
  fakes.add("scancel", "echo 'scancel: error: no permission' >&2; exit 1");
  EXPECT_THAT(io_error_of([&] { launcher.cancel(text); }), HasSubstr("no permission"));
}

TEST(LaunchRecords, come_back_from_their_text_and_refuse_others) {
  const LaunchRecord record{.kind = "ssh",
                            .launch = "first",
                            .folder = "/f",
                            .tasks = 2,
                            .where = {"a", "b"},
                            .conductor = this_process()};
  EXPECT_EQ(launch_record_of(launch_record_text(record)), record);
  for (const char* const text :
       {"", "{}", "[]", R"({"kind":"x","launch":"","folder":"","tasks":1})",
        R"({"kind":"slurm","launch":"","folder":"","tasks":0,"job":"1","gather_job":""})"}) {
    EXPECT_THROW((void)launcher_of(text), InputError) << text;
  }
}

}  // namespace
}  // namespace qsmpc::harness
