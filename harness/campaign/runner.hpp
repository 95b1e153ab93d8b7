// Drives the episodes that a campaign's folder does not have yet.
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

/// How far a campaign is.
struct CampaignProgress {
  std::int64_t done = 0;   ///< episodes in the store
  std::int64_t total = 0;  ///< episodes of the shard, or of what else is driven
  std::int64_t fresh = 0;  ///< of those done, the ones driven since the start of this run
  double elapsed = 0.0;    ///< s, of this run
  std::map<std::string, std::int64_t> outcomes{};  ///< of those done
  /// The first seeds that sufficed, where the campaign's `until` has stopped it.
  std::optional<std::int64_t> stopped_after{};
};

struct CampaignOptions {
  int jobs = 1;  ///< ≥ 1, episodes at the same time
  Shard shard{};
  bool update = false;        ///< go on although the campaign changed; see Store
  bool retry_faults = false;  ///< drive the episodes that faulted again
  /// Asked by several threads: true begins no further episode.
  std::function<bool()> should_stop{};
  /// Asked by several threads: true gives up those that have begun, too.
  std::function<bool()> should_hurry{};
  /// Told what became of a changed campaign, before anything runs.
  std::function<void(const StoreUpdate&)> on_update{};
  /// Told once at the start and after each episode, by one thread at a time.
  std::function<void(const CampaignProgress&)> on_progress{};
};

/// Drives what is missing of `campaign` in `folder`, which is made if need be, and stores it as it
/// is done. Every episode runs on one thread; its row and trace depend on its variant and seed
/// alone, timings aside, for any number of jobs.
///
/// Returns how far it is at the end; done < total if it was stopped. Throws InputError for what is
/// wrong with the campaign, its plants or the store (see Store), IoError when another process works
/// in the folder or something cannot be written; what was stored before stays.
[[nodiscard]] CampaignProgress run_campaign(const Campaign& campaign, const std::string& folder,
                                            const CampaignOptions& options);

/// Where the episodes of a run come from and where they go.
struct EpisodeFlow {
  std::string folder;  ///< that of the store, for the traces that are kept
  Store& store;
  EpisodeSource& source;
};

/// Drives what the source of `flow` gives out until it has nothing left or `options` ask to stop;
/// what they say of shards and stores is the source's and the store's matter. Returns and throws as
/// run_campaign does.
[[nodiscard]] CampaignProgress drive_episodes(const Campaign& campaign, const EpisodeFlow& flow,
                                              const CampaignOptions& options);

/// StoredVariant::plant_digest of each variant. Throws InputError where a vehicle cannot be loaded.
[[nodiscard]] std::vector<std::string> plant_digests(const Campaign& campaign);

}  // namespace qsmpc::harness
