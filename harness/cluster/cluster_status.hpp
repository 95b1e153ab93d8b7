// How far a campaign of tasks is, as anybody who can read its folder may ask at any time. No task's
// store is opened: what is known of episodes is in the marks of finished leases.
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

/// Counts the episodes of finished leases; each lease is read once.
class FinishedEpisodes {
 public:
  /// Looks at the campaign in `folder`. Throws IoError.
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
  CampaignStatus campaign;  ///< running: who waits for the tasks or gathers
  std::int64_t leases = 0;
  std::int64_t finished = 0;    ///< leases
  std::int64_t held = 0;        ///< that a task drives, or drove when it was killed
  std::int64_t given_back = 0;  ///< to be driven by others
  std::int64_t free = 0;        ///< nobody had them
  std::optional<TaskLaunch> launch{};
  /// Of each task, the report of its last start in the last launch.
  std::vector<TaskReport> tasks{};
  std::vector<TaskState> states{};  ///< what the launcher says
  std::string trouble{};            ///< why it does not
};

/// Reads the folder, asks the launcher, and changes nothing. Throws InputError where it has no
/// plan, IoError where it cannot be read.
[[nodiscard]] ClusterStatus cluster_status(const std::string& folder);

[[nodiscard]] std::string cluster_status_table(const ClusterStatus& status);
/// As status_json, with the key "cluster"; docs/cluster.md describes it.
[[nodiscard]] std::string cluster_status_json(const ClusterStatus& status);

}  // namespace qsmpc::harness
