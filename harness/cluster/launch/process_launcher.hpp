// Runs workers as processes on this machine and on machines reached by ssh. This machine alone is
// the host list ":".
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/cluster/launch/host_list.hpp"
#include "harness/cluster/launch/launcher.hpp"
#include "harness/cluster/launch/task_process.hpp"

namespace qsmpc::harness {

struct ProcessLauncherOptions {
  std::string kind;                 ///< "local" or "ssh"
  std::vector<LaunchHost> hosts{};  ///< may be empty if `start` is not called
  std::string program =
      "qsmpc";  ///< what hosts other than ":" run in place of the worker's first word
  std::string ssh_config{};
};

class ProcessLauncher final : public Launcher {
 public:
  explicit ProcessLauncher(ProcessLauncherOptions options) : options_(std::move(options)) {}

  [[nodiscard]] std::string start(const LaunchRequest& request) override;
  [[nodiscard]] std::vector<TaskState> states(const std::string& record) override;
  void cancel(const std::string& record) override;
  [[nodiscard]] bool stays() const override { return true; }
  void wait(const std::string& record, const std::function<bool()>& tick) override;

 private:
  ProcessLauncherOptions options_;
  std::vector<std::unique_ptr<TaskProcess>> processes_;  // by task; null once its end is recorded
};

/// The command, run on this machine, that runs `worker` on `host` as task `task`.
[[nodiscard]] std::vector<std::string> task_command(const ProcessLauncherOptions& options,
                                                    const LaunchHost& host,
                                                    const std::vector<std::string>& worker,
                                                    int task);

}  // namespace qsmpc::harness
