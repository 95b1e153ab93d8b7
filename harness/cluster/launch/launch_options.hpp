// Where workers are started, and the options of each kind of launcher.
#pragma once

#include <string>
#include <vector>

namespace qsmpc::harness {

/// Empty and 0 mean not given.
struct LaunchOptions {
  std::string on;                           ///< "local", "ssh:HOSTS", "ssh:@FILE" or "slurm"
  int tasks = 0;                            ///< workers, 1 by default; with ssh given by the hosts
  int tasks_at_once = 0;                    ///< slurm: maximum number running concurrently
  std::string partition{};                  ///< slurm
  std::string time{};                       ///< slurm: time limit of each task, in sbatch's format
  std::string account{};                    ///< slurm
  std::string sbatch_file{};                ///< slurm: the file of `sbatch_lines`
  std::vector<std::string> sbatch_lines{};  ///< slurm: additional "#SBATCH …" lines of the scripts
  std::string program{};     ///< ssh, slurm: the program there; ssh default: `qsmpc` in PATH
  std::string ssh_config{};  ///< ssh: a file for `ssh -F`

  friend bool operator==(const LaunchOptions&, const LaunchOptions&) = default;
};

inline constexpr int kMostTasks = 100'000;

/// Refuses an unknown kind, options that the kind does not have, and invalid hosts, times and
/// lines. Throws InputError, whose key is the command-line option.
void check_launch_options(const LaunchOptions& options);

/// The number of workers. Throws InputError as check_launch_options does.
[[nodiscard]] int launch_tasks(const LaunchOptions& options);

/// The lines of a file with one "#SBATCH …" each; empty lines and comments are skipped. Throws
/// InputError, with the line, for other lines and for options that the launcher sets itself.
[[nodiscard]] std::vector<std::string> read_sbatch_lines(const std::string& file);

/// Converts `options` to one line of JSON, with absolute file paths, and back. The second function
/// throws InputError on any other text.
[[nodiscard]] std::string launch_options_text(const LaunchOptions& options);
[[nodiscard]] LaunchOptions launch_options_from_text(const std::string& text);

}  // namespace qsmpc::harness
