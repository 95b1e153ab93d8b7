// Workers as tasks of a job array on a Slurm cluster, by its commands sbatch, squeue and scancel.
// Slurm starts them and what comes after them; nothing of this program waits.
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
  /// As squeue says, and of tasks that Slurm has forgotten, as the folder does.
  [[nodiscard]] std::vector<TaskState> states(const std::string& record) override;
  void cancel(const std::string& record) override;
  [[nodiscard]] bool stays() const override { return false; }
  void wait(const std::string& record, const std::function<bool()>& tick) override;

 private:
  LaunchOptions options_;
};

}  // namespace qsmpc::harness
