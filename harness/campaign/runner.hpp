// Drives the episodes that are missing from a campaign's folder.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/episode_source.hpp"
#include "harness/campaign/store/store.hpp"

namespace qsmpc::harness {

/// Progress of a campaign.
struct CampaignProgress {
  std::int64_t done = 0;   ///< episodes in the store
  std::int64_t total = 0;  ///< episodes of the shard, or of the EpisodeSource in general
  std::int64_t fresh = 0;  ///< of `done`, the episodes driven by this run
  double elapsed = 0.0;    ///< s, of this run
  std::map<std::string, std::int64_t> outcomes{};  ///< of the episodes done
  /// Number of first seeds that sufficed, if the campaign's `until` has stopped it.
  std::optional<std::int64_t> stopped_after{};
};

struct CampaignOptions {
  int jobs = 1;  ///< ≥ 1, episodes driven concurrently
  Shard shard{};
  bool update = false;        ///< continue although the campaign changed; see Store
  bool retry_faults = false;  ///< drive faulted episodes again
  /// Polled by several threads: once true, no further episode begins.
  std::function<bool()> should_stop{};
  /// Polled by several threads: once true, the running episodes are abandoned as well.
  std::function<bool()> should_hurry{};
  /// Called before anything runs with the effects of a changed campaign.
  std::function<void(const StoreUpdate&)> on_update{};
  /// Called once at the start and after each episode, by one thread at a time.
  std::function<void(const CampaignProgress&)> on_progress{};
};

/// Drives the episodes of `campaign` that are missing from `folder`, which is created if necessary,
/// and stores each when it is done. Every episode runs on one thread; apart from timings its row
/// and trace depend only on its variant and seed, for any number of jobs.
///
/// Returns the final progress; done < total if it was stopped. Throws InputError if the campaign,
/// its plants or the store (see Store) are invalid, IoError if another process works in the folder
/// or something cannot be written; what was stored before is kept.
[[nodiscard]] CampaignProgress run_campaign(const Campaign& campaign, const std::string& folder,
                                            const CampaignOptions& options);

/// Source and destination of a run's episodes.
struct EpisodeFlow {
  std::string folder;  ///< the store's, also for the kept traces
  Store& store;
  EpisodeSource& source;
};

/// Drives the episodes of `flow.source` until none is left or `options` ask to stop. The members
/// `shard`, `update` and `retry_faults` of `options` have no effect here: they concern the source
/// and the store. Returns and throws as run_campaign does.
[[nodiscard]] CampaignProgress drive_episodes(const Campaign& campaign, const EpisodeFlow& flow,
                                              const CampaignOptions& options);

/// StoredVariant::plant_digest of each variant. Throws InputError if a vehicle cannot be loaded.
[[nodiscard]] std::vector<std::string> plant_digests(const Campaign& campaign);

}  // namespace qsmpc::harness
