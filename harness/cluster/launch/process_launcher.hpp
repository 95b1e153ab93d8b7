// Workers as processes of this machine and of those that ssh reaches. This machine alone is the
// list of hosts ":".
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
  std::vector<LaunchHost> hosts{};  ///< none: `start` is not called
  std::string program =
      "qsmpc";  ///< what hosts other than ":" run instead of the worker's first word
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
  std::vector<std::unique_ptr<TaskProcess>> processes_;  // by number; null: its end is written
};

/// The command on this machine that runs `worker` on `host` for `task`.
[[nodiscard]] std::vector<std::string> task_command(const ProcessLauncherOptions& options,
                                                    const LaunchHost& host,
                                                    const std::vector<std::string>& worker,
                                                    int task);

}  // namespace qsmpc::harness
