// How a campaign's workers are started on machines, asked about and ended. One kind each: this
// machine
// (`local`), machines that ssh reaches (`ssh:HOSTS`), a Slurm cluster (`slurm`).
//
//   const LaunchOptions options{.on = "ssh:one,4/two"};
//   const auto launcher = make_launcher(options);
//   const std::string record =
//       launcher->start({.folder = folder, .worker = words, .tasks = launch_tasks(options)});
//   if (launcher->stays()) launcher->wait(record, [] { return interrupts() == 0; });
//   launcher_of(record)->states(record);   // in any later process
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "harness/cluster/launch/launch_options.hpp"

namespace qsmpc::harness {

/// What is started: tasks 1 … N, each `worker` with the words "--task", "N" after it. Their output
/// is appended to `task_log_path`.
struct LaunchRequest {
  std::string folder;               ///< the campaign's; absolute, the same on every machine
  std::vector<std::string> worker;  ///< e.g. {"/usr/bin/qsmpc", "campaign", "work", folder}
  /// What is run once when all workers have ended; only where the launcher does not stay.
  std::vector<std::string> gather{};
  int tasks = 1;  ///< what `launch_tasks` says of the launcher's options
  int jobs = 1;   ///< cores that each worker uses
};

enum class TaskCondition { kWaiting, kRunning, kDone, kFailed, kCancelled, kLost };

/// "waiting", "running", "done", "failed", "cancelled" or "lost".
[[nodiscard]] const char* task_condition_name(TaskCondition condition);

/// How a worker is, or how it ended. Lost: nobody knows how it ended, e.g. its node or the
/// connection failed.
struct TaskState {
  int task = 0;
  TaskCondition condition = TaskCondition::kWaiting;
  std::string where{};  ///< machine; empty where there is none yet
  std::string note{};   ///< e.g. Slurm's word for it, restarts, exit code and last words; one line

  friend bool operator==(const TaskState&, const TaskState&) = default;
};

/// Members throw IoError where a program that they need fails, with its last words, or where the
/// folder cannot be written, and InputError where `record` is none.
class Launcher {
 public:
  Launcher() = default;
  Launcher(const Launcher&) = delete;
  Launcher& operator=(const Launcher&) = delete;
  Launcher(Launcher&&) = delete;
  Launcher& operator=(Launcher&&) = delete;
  virtual ~Launcher() = default;

  /// Starts the workers. Returns a line of JSON by which `states` and `cancel` of any launcher of
  /// this kind find them again, in any later process and on any machine that has the folder.
  [[nodiscard]] virtual std::string start(const LaunchRequest& request) = 0;

  /// Of each task, by its number.
  [[nodiscard]] virtual std::vector<TaskState> states(const std::string& record) = 0;

  /// Has the workers ended, without waiting for it: they get SIGTERM, some seconds later once more,
  /// and SIGKILL in the end.
  virtual void cancel(const std::string& record) = 0;

  /// Whether the process that started the workers stays until they end and gathers what they did
  /// (local, ssh). Else machines do that (slurm), and it may leave.
  [[nodiscard]] virtual bool stays() const = 0;

  /// Where it stays, in the process that called `start`: waits until all workers have ended. `tick`
  /// is called several times a second; each time that it returns false, the workers get a SIGTERM.
  /// When this process dies, they are ended as by `cancel`. Connections that fail and workers that
  /// end early keep no other from going on. Throws std::logic_error where it does not stay.
  virtual void wait(const std::string& record, const std::function<bool()>& tick) = 0;
};

/// Where what task `task` says is kept in the campaign's folder.
[[nodiscard]] std::string task_log_path(const std::string& folder, int task);

/// Throws InputError where `options` are not those of a launcher, see `check_launch_options`.
[[nodiscard]] std::unique_ptr<Launcher> make_launcher(const LaunchOptions& options);

/// A launcher of the kind that gave the record. Throws InputError where none did.
[[nodiscard]] std::unique_ptr<Launcher> launcher_of(const std::string& record);

}  // namespace qsmpc::harness
