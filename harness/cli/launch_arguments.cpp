#include "harness/cli/launch_arguments.hpp"

#include <string>

#include <CLI/CLI.hpp>

namespace qsmpc::harness {

void add_launch_options(CLI::App& command, LaunchOptions& options) {
  constexpr const char* kGroup = "With --on";
  command
      .add_option("--tasks-at-once", options.tasks_at_once,
                  "slurm: at most so many tasks of the array at the same time")
      ->check(CLI::Range(1, kMostTasks))
      ->group(kGroup);
  command.add_option("--partition", options.partition, "slurm: the partition")->group(kGroup);
  command
      .add_option("--time", options.time,
                  "slurm: limit of each task, e.g. 60 (minutes), 2:30:00 or 1-12 (days-hours)")
      ->group(kGroup);
  command.add_option("--account", options.account, "slurm: whom it is charged to")->group(kGroup);
  command
      .add_option_function<std::string>(
          "--sbatch",
          [&options](const std::string& file) {
            options.sbatch_lines = read_sbatch_lines(file);
            options.sbatch_file = file;
          },
          "slurm: a file of more lines \"#SBATCH --OPTION=VALUE\" for the scripts")
      ->group(kGroup);
  command
      .add_option(
          "--program", options.program,
          "ssh, slurm: the program there; default: with ssh qsmpc in PATH, with slurm this one")
      ->group(kGroup);
  command
      .add_option("--ssh-config", options.ssh_config,
                  "ssh: a configuration instead of ~/.ssh/config, as of ssh -F")
      ->group(kGroup);
}

}  // namespace qsmpc::harness
