// Starts, queries and ends a campaign's workers. One kind of launcher for each of: this machine
// (`local`), machines reached by ssh (`ssh:HOSTS`), a Slurm cluster (`slurm`).
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

/// What to start: tasks 1 … N, each running `worker` with "--task", "N" appended. Their output is
/// appended to `task_log_path`.
struct LaunchRequest {
  std::string folder;               ///< the campaign's; absolute, the same on every machine
  std::vector<std::string> worker;  ///< e.g. {"/usr/bin/qsmpc", "campaign", "work", folder}
  /// Command to run once after all workers have ended; only used if the launcher does not stay.
  std::vector<std::string> gather{};
  int tasks = 1;  ///< `launch_tasks` of the launcher's options
  int jobs = 1;   ///< cores per worker
};

enum class TaskCondition { kWaiting, kRunning, kDone, kFailed, kCancelled, kLost };

/// "waiting", "running", "done", "failed", "cancelled" or "lost".
[[nodiscard]] const char* task_condition_name(TaskCondition condition);

/// The state of a worker. kLost: it is unknown how it ended, e.g. because its node or the
/// connection failed.
struct TaskState {
  int task = 0;
  TaskCondition condition = TaskCondition::kWaiting;
  std::string where{};  ///< its machine; empty if there is none yet
  std::string note{};   ///< one line, e.g. Slurm's state, restarts, exit code and last output

  friend bool operator==(const TaskState&, const TaskState&) = default;
};

/// Members throw IoError if a program that they need fails, with its last line of output, or if the
/// folder cannot be written, and InputError if `record` is not valid.
class Launcher {
 public:
  Launcher() = default;
  Launcher(const Launcher&) = delete;
  Launcher& operator=(const Launcher&) = delete;
  Launcher(Launcher&&) = delete;
  Launcher& operator=(Launcher&&) = delete;
  virtual ~Launcher() = default;

  /// Starts the workers. Returns the record: a line of JSON by which `states` and `cancel` of any
  /// launcher of this kind can find them, in any later process and on any machine that has the
  /// folder.
  [[nodiscard]] virtual std::string start(const LaunchRequest& request) = 0;

  /// The state of each task, by its number.
  [[nodiscard]] virtual std::vector<TaskState> states(const std::string& record) = 0;

  /// Ends the workers, without waiting: they get SIGTERM, a second one some seconds later, and
  /// finally SIGKILL.
  virtual void cancel(const std::string& record) = 0;

  /// Whether the process that started the workers has to stay until they end and then gather their
  /// results (local, ssh). Otherwise the cluster does that (slurm), and the process may exit.
  [[nodiscard]] virtual bool stays() const = 0;

  /// For launchers that stay, in the process that called `start`: waits until all workers have
  /// ended. `tick` is called several times a second; each time it returns false, the workers get
  /// SIGTERM. If this process dies, they are ended as by `cancel`. Failed connections and workers
  /// that end early do not affect the others. Throws std::logic_error if the launcher does not
  /// stay.
  virtual void wait(const std::string& record, const std::function<bool()>& tick) = 0;
};

/// The file in the campaign's folder with the output of task `task`.
[[nodiscard]] std::string task_log_path(const std::string& folder, int task);

/// The launcher of `options`. Throws InputError if they are invalid; see `check_launch_options`.
[[nodiscard]] std::unique_ptr<Launcher> make_launcher(const LaunchOptions& options);

/// A launcher of the kind that wrote the record. Throws InputError if the record is not valid.
[[nodiscard]] std::unique_ptr<Launcher> launcher_of(const std::string& record);

}  // namespace qsmpc::harness
