// Writes the store of a campaign: one SQLite file with a write-ahead log, one transaction per
// episode. An episode is on disk once `add` has returned; otherwise it is not in the store at all,
// however the process ends.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/store/episode_row.hpp"
#include "harness/campaign/store/store_reader.hpp"

namespace qsmpc::harness {

/// The stored form of a campaign with `shard`. `digests`: one per variant, as
/// StoredVariant::plant_digest.
[[nodiscard]] StoredCampaign stored_campaign(const Campaign& campaign, const Shard& shard);
[[nodiscard]] std::vector<StoredVariant> stored_variants(const Campaign& campaign,
                                                         const std::vector<std::string>& digests);

/// What distinguishes campaigns.
struct CampaignIdentity {
  StoredCampaign campaign;
  std::vector<StoredVariant> variants;
};

/// Refuses a store or plan at `path` that is of another campaign. Throws InputError with the first
/// difference; `remedy` is appended to the expected value, e.g. "; --update goes on".
void refuse_other_campaign(const std::string& path, const CampaignIdentity& stored,
                           const CampaignIdentity& asked, const std::string& remedy);

/// The effects of a changed campaign on the contents of its store.
struct StoreUpdate {
  bool changed = false;
  std::int64_t kept = 0;              ///< episodes
  std::int64_t dropped = 0;           ///< episodes that are no longer part of the campaign
  std::vector<std::string> traces{};  ///< folders of their traces, relative to the campaign's
};

/// Which processes use a store's file while it is open.
enum class StoreUse {
  /// This process writes, others may read. The log's index is in shared memory of the machine, so
  /// the file must be on a local file system.
  kShared,
  /// Only this process; the caller guarantees it. Nothing is locked and no memory is shared, so the
  /// file may be on a network file system, however that treats locks.
  kAlone
};

/// Thread-safe.
class Store {
 public:
  /// Opens the store in `folder`, which exists and is locked by the caller. Creates the store if
  /// there is none; upgrades an older schema. `seeds` are the campaign's.
  ///
  /// A store of another campaign is refused, with the difference, unless `update` is true: it then
  /// keeps the episodes that both campaigns have (same variant with the same resolved scenario and
  /// vehicle, same seed) and drops the others.
  ///
  /// Throws InputError if the store is refused, also if its schema is newer; IoError if it cannot
  /// be read or written.
  Store(const std::string& folder, const StoredCampaign& campaign,
        const std::vector<StoredVariant>& variants, const SeedSet& seeds, bool update,
        StoreUse use = StoreUse::kShared);
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  [[nodiscard]] const StoreUpdate& update() const;
  /// EpisodeRow::variant of each variant, in the campaign's order.
  [[nodiscard]] const std::vector<std::int64_t>& variant_ids() const;

  /// The outcome of the episode, if it is in the store.
  [[nodiscard]] std::optional<std::string> outcome(std::int64_t variant, std::uint64_t seed) const;
  /// The number of episodes by outcome.
  [[nodiscard]] std::map<std::string, std::int64_t> outcomes() const;

  /// Adds an episode; an existing one is replaced if `replace` is true. Throws IoError if it cannot
  /// be written, e.g. because the disk is full; the store is then unchanged.
  void add(const EpisodeRow& row, bool replace);

  /// Visits the outcome of each episode, in any order.
  void for_each_outcome(
      const std::function<void(std::int64_t variant, std::uint64_t seed, const std::string& outcome,
                               bool unsafe)>& visit) const;

  /// Records that the campaign has stopped after the first `count` seeds of `seeds`, and removes
  /// the episodes of later seeds. Returns the folders of their traces, relative to the campaign's.
  std::vector<std::string> stop_after(const SeedSet& seeds, std::int64_t count);

  /// Folds the log into the store's file, so that it can be copied, and read where nothing can be
  /// written. Has no effect while others read the store.
  void fold();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace qsmpc::harness
