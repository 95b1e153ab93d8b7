// Reads a campaign's store, during or after the campaign, on any machine. Nothing is written.
//
//   const StoreReader store("out/my_campaign");
//   for (const StoredVariant& variant : store.variants()) {
//     store.for_each_episode(variant.id, [&](const EpisodeRow& row) { … });
//   }
//
// All rows are streamed, so memory does not grow with the number of episodes. A reader sees a
// snapshot of the store: what is added during its lifetime is not visible.
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

/// A variant as stored.
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

/// The stored properties of a campaign besides its variants.
struct StoredCampaign {
  std::string name;
  std::string version;  ///< of the program that made the store
  std::string seeds;    ///< seeds_text of the campaign's
  std::string traces;   ///< traces_text of the campaign
  Shard shard{};
  std::int64_t episodes = 0;  ///< of this shard when complete; with `until` the maximum
  /// Campaign::risk_against_cost. No episode depends on it, so the store adopts changes.
  std::vector<VariantFamily> risk_against_cost{};
  std::optional<StopCriterion> until{};
  /// The number of first seeds after which the rule `until` has stopped; the store has the episodes
  /// of these.
  std::optional<std::int64_t> stopped_after{};
  std::string rare{};  ///< rare_text of the campaign

  friend bool operator==(const StoredCampaign&, const StoredCampaign&) = default;
};

/// A column of the table of episodes.
enum class EpisodeNumber { kCost, kMinClearance, kTimeToTarget };

/// Not thread-safe.
class StoreReader {
 public:
  /// Opens the store of the campaign in `folder`. Throws InputError if there is none, or one of
  /// another schema, with the remedy; IoError if it cannot be read.
  explicit StoreReader(const std::string& folder);
  ~StoreReader();
  /// Verifies every episode against its checksum. Throws IoError naming the first one that does not
  /// match, or if the store cannot be read.
  void verify() const;
  StoreReader(const StoreReader&) = delete;
  StoreReader& operator=(const StoreReader&) = delete;

  [[nodiscard]] const StoredCampaign& campaign() const;
  [[nodiscard]] const std::vector<StoredVariant>& variants() const;

  /// The number of episodes done, by outcome.
  [[nodiscard]] std::map<std::string, std::int64_t> outcomes() const;
  /// The number of episodes finished at or after `time` (s since 1970-01-01 00:00 UTC).
  [[nodiscard]] std::int64_t finished_since(double time) const;

  /// Visits the episodes of a variant by seed, without their periods.
  void for_each_episode(std::int64_t variant,
                        const std::function<void(const EpisodeRow&)>& visit) const;
  /// Visits the pairs of episodes of two variants with the same seed, by seed, without their
  /// periods.
  void for_each_pair(std::int64_t first, std::int64_t second,
                     const std::function<void(const EpisodeRow&, const EpisodeRow&)>& visit) const;
  /// Visits the episodes of several variants together, by seed, without their periods: `visit` is
  /// called for each seed that any of them has, with the episode of each of `variants`, or a null
  /// pointer for one without that seed. `variants` must be distinct.
  void for_each_seed(const std::vector<std::int64_t>& variants,
                     const std::function<void(std::uint64_t seed,
                                              const std::vector<const EpisodeRow*>&)>& visit) const;
  /// Visits the periods of a variant's episodes by seed and period; `period` counts from 0.
  void for_each_period(std::int64_t variant,
                       const std::function<void(std::uint64_t seed, std::int64_t period,
                                                const PeriodRow&)>& visit) const;
  /// Visits at most `most` of a variant's episodes that have a path: failures (is_failure) first,
  /// then the others, each by seed.
  void for_each_path(std::int64_t variant, std::int64_t most,
                     const std::function<void(const std::string& outcome,
                                              const std::vector<PathPoint>& path)>& visit) const;
  /// Visits the folders of the kept traces, relative to the campaign's.
  void for_each_trace(const std::function<void(const std::string& folder)>& visit) const;
  /// Visits the rare-outcome rows of a variant's episodes, by seed; episodes without one are
  /// skipped.
  void for_each_rare(std::int64_t variant,
                     const std::function<void(std::uint64_t seed, const RareRow&)>& visit) const;
  /// Visits the values of a column over a variant's episodes in ascending order, without faulted
  /// episodes and missing values.
  void for_each_sorted(std::int64_t variant, EpisodeNumber number,
                       const std::function<void(double)>& visit) const;
  /// Visits ocp_ms of a variant's periods, by seed and period.
  void for_each_ocp_ms(std::int64_t variant, const std::function<void(double)>& visit) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace qsmpc::harness
