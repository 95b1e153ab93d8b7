// A campaign's store, read: while the campaign runs, after it, on any machine. Nothing is written.
//
//   const StoreReader store("out/my_campaign");
//   for (const StoredVariant& variant : store.variants()) {
//     store.for_each_episode(variant.id, [&](const EpisodeRow& row) { … });
//   }
//
// All numbers come as a stream, so that memory does not grow with the number of episodes. One
// reader sees one state of the store: what is added while it lives is not seen.
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

namespace qsmpc::harness {

/// A variant as the store knows it.
struct StoredVariant {
  std::int64_t id = 0;  ///< EpisodeRow::variant; 0, 1, …
  std::string name;
  std::string scenario;
  std::string settings;
  std::string plant;          ///< empty: the scenario's own
  std::string scenario_text;  ///< resolved, as YAML
  std::string plant_digest;   ///< of the vehicle's compiled model; empty for an analytic plant

  friend bool operator==(const StoredVariant&, const StoredVariant&) = default;
};

/// What is asked for besides the variants.
struct StoredCampaign {
  std::string name;
  std::string version;  ///< of the program that made the store
  std::string seeds;    ///< seeds_text of the campaign's
  std::string traces;   ///< traces_text of the campaign
  Shard shard{};
  std::int64_t episodes = 0;  ///< of this shard, when all are done; with `until` at most
  /// Campaign::risk_against_cost. No episode depends on it: the store takes what it is now.
  std::vector<VariantFamily> risk_against_cost{};
  std::optional<StopCriterion> until{};
  /// After so many first seeds the rule `until` has stopped; the store has the episodes of these.
  std::optional<std::int64_t> stopped_after{};
  std::string rare{};  ///< rare_text of the campaign

  friend bool operator==(const StoredCampaign&, const StoredCampaign&) = default;
};

/// A column of the table of episodes.
enum class EpisodeNumber { kCost, kMinClearance, kTimeToTarget };

/// To be used by one thread at a time.
class StoreReader {
 public:
  /// Opens the store of the campaign in `folder`. Throws InputError where there is none, or one of
  /// another schema, with what to do about it; IoError where it cannot be read.
  explicit StoreReader(const std::string& folder);
  ~StoreReader();
  /// Compares every episode with its checksum. Throws IoError that names the first one that is not
  /// as it was written, and where the store cannot be read.
  void verify() const;
  StoreReader(const StoreReader&) = delete;
  StoreReader& operator=(const StoreReader&) = delete;

  [[nodiscard]] const StoredCampaign& campaign() const;
  [[nodiscard]] const std::vector<StoredVariant>& variants() const;

  /// Episodes done, by outcome.
  [[nodiscard]] std::map<std::string, std::int64_t> outcomes() const;
  /// How many were finished at `time` (s since 1970-01-01 00:00 UTC) or later.
  [[nodiscard]] std::int64_t finished_since(double time) const;

  /// The episodes of a variant by seed, without their periods.
  void for_each_episode(std::int64_t variant,
                        const std::function<void(const EpisodeRow&)>& visit) const;
  /// The episodes that two variants have with the same seed, by seed, without their periods.
  void for_each_pair(std::int64_t first, std::int64_t second,
                     const std::function<void(const EpisodeRow&, const EpisodeRow&)>& visit) const;
  /// The episodes of several variants at once, by seed, without their periods: `visit` is called
  /// for each seed that any of them has, with an episode for each of `variants`, or a null pointer
  /// where one does not have it. A variant may be named once.
  void for_each_seed(const std::vector<std::int64_t>& variants,
                     const std::function<void(std::uint64_t seed,
                                              const std::vector<const EpisodeRow*>&)>& visit) const;
  /// The periods of a variant's episodes by seed and period; `period` is their number, from 0.
  void for_each_period(std::int64_t variant,
                       const std::function<void(std::uint64_t seed, std::int64_t period,
                                                const PeriodRow&)>& visit) const;
  /// At most `most` of a variant's episodes that have a path: those that are a failure (is_failure)
  /// before others, each by seed.
  void for_each_path(std::int64_t variant, std::int64_t most,
                     const std::function<void(const std::string& outcome,
                                              const std::vector<PathPoint>& path)>& visit) const;
  /// The folders of the traces that are kept, relative to the campaign's.
  void for_each_trace(const std::function<void(const std::string& folder)>& visit) const;
  /// What the episodes of a variant say of rare outcomes, by seed; those that say nothing are left
  /// out.
  void for_each_rare(std::int64_t variant,
                     const std::function<void(std::uint64_t seed, const RareRow&)>& visit) const;
  /// A number of a variant's episodes, ascending; of those that did not fault and have one.
  void for_each_sorted(std::int64_t variant, EpisodeNumber number,
                       const std::function<void(double)>& visit) const;
  /// ocp_ms of a variant's periods, by seed and period.
  void for_each_ocp_ms(std::int64_t variant, const std::function<void(double)>& visit) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace qsmpc::harness
