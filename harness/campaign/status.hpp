// The progress of a campaign, for any process that can read its folder, at any time.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "harness/campaign/runner.hpp"
#include "harness/campaign/store/folder_lock.hpp"
#include "harness/campaign/store/store_reader.hpp"

namespace qsmpc::harness {

struct CampaignStatus {
  StoredCampaign campaign;
  std::int64_t done = 0;
  std::map<std::string, std::int64_t> outcomes{};
  std::optional<LockHolder> running{};  ///< the process that works on it
  double rate = 0.0;                    ///< recent episodes per second; 0 if no process works on it
  std::optional<double> left{};         ///< s, at that rate; nothing if it is 0
};

/// Reads the store and the lock in `folder` and changes nothing. Throws as StoreReader and
/// lock_holder do.
[[nodiscard]] CampaignStatus campaign_status(const std::string& folder);

[[nodiscard]] std::string status_table(const CampaignStatus& status);
/// Parts of status_table: the lines with the episodes done and their outcomes, and the line with
/// the rate.
[[nodiscard]] std::string done_text(const CampaignStatus& status);
[[nodiscard]] std::string rate_text(const CampaignStatus& status);
/// One object, ending in a newline: name, shard, episodes, done, outcomes, running, rate, left.
[[nodiscard]] std::string status_json(const CampaignStatus& status);

/// "12.3 episodes/s, 1 min 20 s left; reached 950, timeout 3".
[[nodiscard]] std::string progress_note(const CampaignProgress& progress);

/// "850 ms", "12 s", "1 min 20 s", "3 h 5 min": seconds ≥ 0 in its two largest units.
[[nodiscard]] std::string duration_text(double seconds);

}  // namespace qsmpc::harness
