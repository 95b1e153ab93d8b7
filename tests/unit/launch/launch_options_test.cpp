#include "harness/cluster/launch/launch_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string refusal_of_options(const LaunchOptions& options) {
  try {
    check_launch_options(options);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(LaunchOptions, are_refused_by_kinds_that_do_not_have_them) {
  EXPECT_EQ(refusal_of_options({.on = "local", .partition = "long"}),
            "--partition: found long, expected none with --on local");
  EXPECT_THAT(refusal_of_options({.on = "local", .program = "/q"}), StartsWith("--program"));
  EXPECT_THAT(refusal_of_options({.on = "local", .ssh_config = "/c"}), StartsWith("--ssh-config"));
  EXPECT_THAT(refusal_of_options({.on = "local", .tasks_at_once = 2}),
              StartsWith("--tasks-at-once"));
  EXPECT_THAT(refusal_of_options({.on = "ssh:a", .time = "60"}), StartsWith("--time"));
  EXPECT_THAT(refusal_of_options({.on = "ssh:a", .tasks = 2}), HasSubstr("N/HOST"));
  EXPECT_THAT(refusal_of_options({.on = "slurm", .ssh_config = "/c"}), StartsWith("--ssh-config"));
  EXPECT_THAT(refusal_of_options({.on = "cloud"}), HasSubstr("expected local, ssh:HOSTS"));
  EXPECT_EQ(refusal_of_options({.on = "slurm",
                                .tasks = 9,
                                .tasks_at_once = 3,
                                .partition = "a,b",
                                .time = "1-12:00:00",
                                .account = "me",
                                .program = "/q"}),
            "");
}

TEST(LaunchOptions, with_a_time_or_a_name_that_slurm_does_not_take_are_refused) {
  for (const char* const time :
       {"60", "60:30", "2:30:00", "1-0", "1-12:30", "1-12:30:59", "UNLIMITED"}) {
    EXPECT_EQ(refusal_of_options({.on = "slurm", .time = time}), "");
  }
  for (const char* const time : {"1h", "1-", ":30", "1:2:3:4", "-5", "60\n#SBATCH --wrap=x"}) {
    EXPECT_THAT(refusal_of_options({.on = "slurm", .time = time}), StartsWith("--time")) << time;
  }
  EXPECT_THAT(refusal_of_options({.on = "slurm", .partition = "a b"}), StartsWith("--partition"));
  EXPECT_THAT(refusal_of_options({.on = "slurm", .account = "a\nb"}), StartsWith("--account"));
}

TEST(LaunchOptions, say_how_many_workers_there_are) {
  EXPECT_EQ(launch_tasks({.on = "local"}), 1);
  EXPECT_EQ(launch_tasks({.on = "slurm", .tasks = 20}), 20);
  EXPECT_EQ(launch_tasks({.on = "ssh:a,4/b,2*c"}), 7);
}

TEST(LaunchOptions, come_back_from_their_text) {
  const LaunchOptions options{.on = "slurm",
                              .tasks = 20,
                              .tasks_at_once = 4,
                              .partition = "long",
                              .time = "60",
                              .account = "me",
                              .sbatch_file = "/lines",
                              .sbatch_lines = {"#SBATCH --mem=4G"},
                              .program = "/opt/qsmpc"};
  EXPECT_EQ(launch_options_from_text(launch_options_text(options)), options);
  EXPECT_THAT(launch_options_text({.on = "ssh:@/a/../hosts"}), HasSubstr("\"ssh:@/hosts\""));
  EXPECT_THROW((void)launch_options_from_text("{}"), InputError);
  EXPECT_THROW((void)launch_options_from_text("nothing"), InputError);
}

TEST(LaunchOptions, take_lines_of_sbatch_and_refuse_those_that_are_their_own) {
  const qsmpc::testing::TemporaryFolder folder;
  EXPECT_THAT(read_sbatch_lines(folder.file("good",
                                            "# memory\n#SBATCH --mem=4G\n\n"
                                            "#SBATCH -C \"big mem\"  \r\n")),
              ElementsAre("#SBATCH --mem=4G", "#SBATCH -C \"big mem\""));
  const auto refusal = [&folder](const std::string& text) -> std::string {
    try {
      (void)read_sbatch_lines(folder.file("bad", text));
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_THAT(
      refusal("#SBATCH --mem=1\n#SBATCH --array=1-3\n"),
      HasSubstr("bad:2: --sbatch: found --array, expected an option that qsmpc does not set"));
  EXPECT_THAT(refusal("#SBATCH -o x\n"), HasSubstr("found -o"));
  EXPECT_THAT(refusal("rm -rf /\n"),
              HasSubstr("bad:1: --sbatch: found rm -rf /, expected #SBATCH"));
  EXPECT_THAT(refusal("#SBATCH mem\n"), HasSubstr("bad:1"));
}

}  // namespace
}  // namespace qsmpc::harness
