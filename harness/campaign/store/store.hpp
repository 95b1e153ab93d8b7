// The store of a campaign, written: one SQLite file with a write-ahead log, one transaction an
// episode. What `add` returned from is on the disk; what it did not return from is not there at
// all, however the process ends.
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

/// What a campaign with `shard` of it is to the store. `digests`: one a variant, as
/// StoredVariant::plant_digest.
[[nodiscard]] StoredCampaign stored_campaign(const Campaign& campaign, const Shard& shard);
[[nodiscard]] std::vector<StoredVariant> stored_variants(const Campaign& campaign,
                                                         const std::vector<std::string>& digests);

/// What tells campaigns apart.
struct CampaignIdentity {
  StoredCampaign campaign;
  std::vector<StoredVariant> variants;
};

/// Refuses a store or plan at `path` of another campaign. Throws InputError with the first thing
/// that differs; `remedy` follows what is expected, e.g. "; --update goes on".
void refuse_other_campaign(const std::string& path, const CampaignIdentity& stored,
                           const CampaignIdentity& asked, const std::string& remedy);

/// What became of what a store held when its campaign changed.
struct StoreUpdate {
  bool changed = false;
  std::int64_t kept = 0;              ///< episodes
  std::int64_t dropped = 0;           ///< episodes that the campaign no longer asks for
  std::vector<std::string> traces{};  ///< folders of their traces, relative to the campaign's
};

/// Who uses the file of a store while it is open.
enum class StoreUse {
  /// This process writes, others may read: the log's index is in memory that processes of one
  /// machine share, so the file has to be on a file system of the machine itself.
  kShared,
  /// No other process, which is the caller's promise. Nothing is locked and no memory is shared, so
  /// that the file may be on a network's file system, whatever that makes of locks.
  kAlone
};

/// May be used by several threads at once.
class Store {
 public:
  /// Opens the store in `folder`, which exists and is locked by the caller; makes it where there is
  /// none; brings an older schema up to date. `seeds` are the campaign's.
  ///
  /// A store of another campaign is refused with what differs, unless `update`: it then keeps the
  /// episodes that both campaigns ask for (the same variant with the same resolved scenario and
  /// vehicle, and the seed), and drops the others.
  ///
  /// Throws InputError on a store that is refused, also one of a newer schema; IoError where it
  /// cannot be read or written.
  Store(const std::string& folder, const StoredCampaign& campaign,
        const std::vector<StoredVariant>& variants, const SeedSet& seeds, bool update,
        StoreUse use = StoreUse::kShared);
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  [[nodiscard]] const StoreUpdate& update() const;
  /// EpisodeRow::variant of each variant, in the campaign's order.
  [[nodiscard]] const std::vector<std::int64_t>& variant_ids() const;

  /// How the episode ended, if it is there.
  [[nodiscard]] std::optional<std::string> outcome(std::int64_t variant, std::uint64_t seed) const;
  /// Episodes by outcome.
  [[nodiscard]] std::map<std::string, std::int64_t> outcomes() const;

  /// Adds an episode; one that is there is replaced if `replace`. Throws IoError when it cannot be
  /// written, e.g. on a full disk; the store is then as before.
  void add(const EpisodeRow& row, bool replace);

  /// How each episode ended, in any order.
  void for_each_outcome(
      const std::function<void(std::int64_t variant, std::uint64_t seed, const std::string& outcome,
                               bool unsafe)>& visit) const;

  /// Notes that the campaign has stopped after its first `count` seeds of `seeds`, and removes the
  /// episodes of those that follow. Returns the folders of their traces, relative to the
  /// campaign's.
  std::vector<std::string> stop_after(const SeedSet& seeds, std::int64_t count);

  /// Puts all into the one file, so that it may be copied, and read where nothing can be written.
  /// Left undone while others read it.
  void fold();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace qsmpc::harness
