// A campaign: which episodes are driven, and what is kept of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "harness/scenario/scenario.hpp"
#include "harness/splitting/splitting.hpp"

namespace qsmpc::harness {

/// Which episodes keep their trace file. A failure is an episode that did not reach the target, or
/// whose true state entered the unsafe set.
enum class TraceKeeping { kNone, kFailures, kAll };

/// "none", "failures" or "all".
[[nodiscard]] const char* trace_keeping_name(TraceKeeping keeping);

/// The seeds of a campaign, each once: first, first + 1, … or those listed.
struct SeedSet {
  std::uint64_t first = 0;
  std::int64_t count = 0;               ///< ≥ 1 where `listed` is empty
  std::vector<std::uint64_t> listed{};  ///< instead of first and count

  [[nodiscard]] std::int64_t size() const {
    return listed.empty() ? count : static_cast<std::int64_t>(listed.size());
  }
  /// Seed `index`, 0 ≤ index < size().
  [[nodiscard]] std::uint64_t at(std::int64_t index) const {
    return listed.empty() ? first + static_cast<std::uint64_t>(index)
                          : listed[static_cast<std::size_t>(index)];
  }
  friend bool operator==(const SeedSet&, const SeedSet&) = default;
};

/// "0 to 999", or "3, 5, 8" for those that are listed.
[[nodiscard]] std::string seeds_text(const SeedSet& seeds);
/// The inverse of `seeds_text`. Throws std::invalid_argument on something else.
[[nodiscard]] SeedSet seeds_from_text(const std::string& text);

/// Where seeds are among those of a set.
class SeedPlaces {
 public:
  explicit SeedPlaces(const SeedSet& seeds);
  /// The index of `seed`, as SeedSet::at has it; nothing for a seed of no such set.
  [[nodiscard]] std::optional<std::int64_t> of(std::uint64_t seed) const;

 private:
  std::uint64_t first_;
  std::int64_t count_;
  std::unordered_map<std::uint64_t, std::int64_t> listed_{};
};

/// Which part of a campaign is driven: every `count`-th seed from the `index`-th on.
struct Shard {
  std::int64_t index = 1;  ///< 1 … count
  std::int64_t count = 1;

  /// Whether it has the seed at `seed_index` of the campaign.
  [[nodiscard]] bool has(std::int64_t seed_index) const { return seed_index % count == index - 1; }
  /// How many of `seeds` seeds it has.
  [[nodiscard]] std::int64_t share(std::int64_t seeds) const {
    return (seeds - index + count) / count;
  }
  friend bool operator==(const Shard&, const Shard&) = default;
};

/// One way to drive: a scenario with settings on a plant.
struct CampaignVariant {
  std::string name;      ///< of all that makes it differ; unique in the campaign
  std::string scenario;  ///< as the campaign file names it
  std::string settings;  ///< label of the file's variant and grid point; may be empty
  std::vector<std::string> overrides{};  ///< KEY=VALUE, in the order in which they are applied
  std::string plant;                     ///< as the campaign file names it; empty: the scenario's
  Scenario resolved;                     ///< with all of it applied; its seed is 0
};

/// Settings whose variants are joined by a line in the figure of risk against cost.
struct VariantFamily {
  std::string name;
  std::vector<std::string> settings{};  ///< CampaignVariant::settings, along the line; each once

  friend bool operator==(const VariantFamily&, const VariantFamily&) = default;
};

/// StopCriterion::of that counts the episodes whose true state entered the unsafe set.
inline constexpr const char* kUnsafeEvent = "unsafe";

/// When a campaign has driven enough seeds: see StopRule.
struct StopCriterion {
  std::string of = kUnsafeEvent;  ///< kUnsafeEvent, or outcome_name of an outcome
  double rate_halfwidth = 0.0;    ///< in (0, 0.5): of the interval of each variant's rate, at most
  double confidence = 0.99;  ///< in (0, 1), of each variant's interval, at every number of seeds

  friend bool operator==(const StopCriterion&, const StopCriterion&) = default;
};

/// "unsafe to +-0.001 at 99 %"; "none" without one.
[[nodiscard]] std::string until_text(const std::optional<StopCriterion>& until);

/// How rare outcomes are looked for.
struct RareSettings {
  SplitSettings splitting{};
  bool certify = true;  ///< whether every drive is certified, so that certificates can be compared
};

/// Every variant is driven with every seed. The same seed gives every variant the same random
/// numbers: what differs between variants is paired by seed.
struct Campaign {
  std::string name;
  std::vector<CampaignVariant> variants;  ///< at least one; by scenario, settings, plant
  SeedSet seeds;
  TraceKeeping traces = TraceKeeping::kNone;
  /// With kFailures: of each variant, the first this many seeds keep their trace, too.
  std::int64_t trace_sample = 0;
  /// The lines of the figure of risk against cost, by name; without any there is no such figure.
  std::vector<VariantFamily> risk_against_cost{};
  /// Fewer seeds than `seeds` are driven where fewer suffice.
  std::optional<StopCriterion> until{};
  /// Where rare outcomes are looked for: how every seed of a variant also estimates how probable it
  /// is that a drive is unsafe.
  std::optional<RareSettings> rare{};

  /// At most.
  [[nodiscard]] std::int64_t episodes() const {
    return static_cast<std::int64_t>(variants.size()) * seeds.size();
  }
};

/// "none", "all", or "failures, sample N".
[[nodiscard]] std::string traces_text(const Campaign& campaign);

/// "200 particles, 1 killed, floor 1e-12, certified"; empty where rare outcomes are not looked for.
[[nodiscard]] std::string rare_text(const Campaign& campaign);

}  // namespace qsmpc::harness
