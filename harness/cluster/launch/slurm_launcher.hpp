// Runs workers as tasks of a job array on a Slurm cluster, using sbatch, squeue and scancel. Slurm
// starts them and the job after them; no process of this program waits.
#pragma once

#include <string>
#include <vector>

#include "harness/cluster/launch/launch_options.hpp"
#include "harness/cluster/launch/launcher.hpp"

namespace qsmpc::harness {

class SlurmLauncher final : public Launcher {
 public:
  explicit SlurmLauncher(LaunchOptions options) : options_(std::move(options)) {}

  /// Writes the scripts into `cluster/slurm` of the folder and submits them.
  [[nodiscard]] std::string start(const LaunchRequest& request) override;
  /// According to squeue, and for tasks that Slurm has forgotten, according to the folder.
  [[nodiscard]] std::vector<TaskState> states(const std::string& record) override;
  void cancel(const std::string& record) override;
  [[nodiscard]] bool stays() const override { return false; }
  void wait(const std::string& record, const std::function<bool()>& tick) override;

 private:
  LaunchOptions options_;
};

}  // namespace qsmpc::harness
