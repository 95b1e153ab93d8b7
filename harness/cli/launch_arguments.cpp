#include "harness/cli/launch_arguments.hpp"

#include <string>

#include <CLI/CLI.hpp>

namespace qsmpc::harness {

void add_launch_options(CLI::App& command, LaunchOptions& options) {
  constexpr const char* kGroup = "With --on";
  command
      .add_option("--tasks-at-once", options.tasks_at_once,
                  "slurm: maximum number of simultaneous tasks of the array")
      ->check(CLI::Range(1, kMostTasks))
      ->group(kGroup);
  command.add_option("--partition", options.partition, "slurm: the partition")->group(kGroup);
  command
      .add_option("--time", options.time,
                  "slurm: limit of each task, e.g. 60 (minutes), 2:30:00 or 1-12 (days-hours)")
      ->group(kGroup);
  command.add_option("--account", options.account, "slurm: the account to charge")->group(kGroup);
  command
      .add_option_function<std::string>(
          "--sbatch",
          [&options](const std::string& file) {
            options.sbatch_lines = read_sbatch_lines(file);
            options.sbatch_file = file;
          },
          "slurm: a file of additional lines \"#SBATCH --OPTION=VALUE\" for the scripts")
      ->group(kGroup);
  command
      .add_option("--program", options.program,
                  "ssh, slurm: path of qsmpc on the hosts; default: with ssh, qsmpc in PATH; with "
                  "slurm, this program")
      ->group(kGroup);
  command
      .add_option("--ssh-config", options.ssh_config,
                  "ssh: a configuration file to use instead of ~/.ssh/config, like ssh -F")
      ->group(kGroup);
}

}  // namespace qsmpc::harness
