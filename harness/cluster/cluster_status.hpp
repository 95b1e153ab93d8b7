// The progress of a campaign driven by tasks, for any process that can read its folder, at any
// time. No task's store is opened: the episode counts come from the files of finished leases.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/campaign/status.hpp"
#include "harness/cluster/launch/launcher.hpp"
#include "harness/cluster/launch_file.hpp"
#include "harness/cluster/task_report.hpp"

namespace qsmpc::harness {

/// Counts the episodes of finished leases, reading each lease once.
class FinishedEpisodes {
 public:
  /// Reads the leases finished since the last call in the campaign's `folder`. Throws IoError.
  void look(const std::string& folder);

  [[nodiscard]] std::int64_t leases() const { return std::ssize(leases_); }
  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] const std::map<std::string, std::int64_t>& outcomes() const { return outcomes_; }

 private:
  std::set<std::int64_t> leases_{};
  std::int64_t count_ = 0;
  std::map<std::string, std::int64_t> outcomes_{};
};

struct ClusterStatus {
  CampaignStatus campaign;  ///< running: the process that waits for the tasks or gathers
  std::int64_t leases = 0;
  std::int64_t finished = 0;    ///< finished leases
  std::int64_t held = 0;        ///< leases that a task drives, or drove when it was killed
  std::int64_t given_back = 0;  ///< leases to be driven by other tasks
  std::int64_t free = 0;        ///< leases never claimed
  std::optional<TaskLaunch> launch{};
  /// The report of each task's last start in the last launch.
  std::vector<TaskReport> tasks{};
  std::vector<TaskState> states{};  ///< according to the launcher
  std::string trouble{};            ///< why the launcher could not be asked; empty otherwise
};

/// Reads the folder and asks the launcher, without changing anything. Throws InputError if the
/// folder has no plan, IoError if it cannot be read.
[[nodiscard]] ClusterStatus cluster_status(const std::string& folder);

[[nodiscard]] std::string cluster_status_table(const ClusterStatus& status);
/// Like status_json, with the additional key "cluster"; docs/cluster.md describes it.
[[nodiscard]] std::string cluster_status_json(const ClusterStatus& status);

}  // namespace qsmpc::harness
