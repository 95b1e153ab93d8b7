// Where workers are started, and what the kinds of launchers may be told.
#pragma once

#include <string>
#include <vector>

namespace qsmpc::harness {

/// Empty and 0: not given.
struct LaunchOptions {
  std::string on;                           ///< "local", "ssh:HOSTS", "ssh:@FILE" or "slurm"
  int tasks = 0;                            ///< workers; 1 unless given; of ssh the hosts say it
  int tasks_at_once = 0;                    ///< slurm: so many of them at the same time
  std::string partition{};                  ///< slurm
  std::string time{};                       ///< slurm: limit of each task, as sbatch takes it
  std::string account{};                    ///< slurm
  std::string sbatch_file{};                ///< slurm: where `sbatch_lines` are from
  std::vector<std::string> sbatch_lines{};  ///< slurm: more lines "#SBATCH …" of the scripts
  std::string program{};     ///< ssh, slurm: the program there; ssh: `qsmpc` in PATH unless given
  std::string ssh_config{};  ///< ssh: a file for `ssh -F`

  friend bool operator==(const LaunchOptions&, const LaunchOptions&) = default;
};

inline constexpr int kMostTasks = 100'000;

/// Refuses an unknown kind, options that the kind does not have, hosts, times and lines that are
/// none. Throws InputError, whose key is the option of the command line.
void check_launch_options(const LaunchOptions& options);

/// How many workers there are. Throws InputError as check_launch_options does.
[[nodiscard]] int launch_tasks(const LaunchOptions& options);

/// The lines of a file with one "#SBATCH …" each; empty ones and comments are left out. Throws
/// InputError, with the line, for others and for options that the launcher sets itself.
[[nodiscard]] std::vector<std::string> read_sbatch_lines(const std::string& file);

/// `options` as one line of JSON, with files by their absolute paths, and back. The second throws
/// InputError on something else.
[[nodiscard]] std::string launch_options_text(const LaunchOptions& options);
[[nodiscard]] LaunchOptions launch_options_from_text(const std::string& text);

}  // namespace qsmpc::harness
