// A campaign: the episodes to drive and what to keep of them.
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

/// The distinct seeds of a campaign: first, first + 1, … or those listed.
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

/// "0 to 999", or "3, 5, 8" for listed seeds.
[[nodiscard]] std::string seeds_text(const SeedSet& seeds);
/// The inverse of `seeds_text`. Throws std::invalid_argument on any other text.
[[nodiscard]] SeedSet seeds_from_text(const std::string& text);

/// Maps seeds to their index in a SeedSet.
class SeedPlaces {
 public:
  explicit SeedPlaces(const SeedSet& seeds);
  /// The index of `seed`, the inverse of SeedSet::at; nothing if the set does not contain it.
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

  /// Whether the shard contains the campaign's seed at `seed_index`.
  [[nodiscard]] bool has(std::int64_t seed_index) const { return seed_index % count == index - 1; }
  /// How many of a campaign's `seeds` seeds the shard contains.
  [[nodiscard]] std::int64_t share(std::int64_t seeds) const {
    return (seeds - index + count) / count;
  }
  friend bool operator==(const Shard&, const Shard&) = default;
};

/// One way to drive: a scenario with settings on a plant.
struct CampaignVariant {
  std::string name;      ///< made of everything that makes it differ; unique in the campaign
  std::string scenario;  ///< as the campaign file names it
  std::string settings;  ///< label of the file's variant and grid point; may be empty
  std::vector<std::string> overrides{};  ///< KEY=VALUE, in order of application
  std::string plant;                     ///< as the campaign file names it; empty: the scenario's
  Scenario resolved;                     ///< with all of this applied; its seed is 0
};

/// Settings whose variants are joined by a line in the risk-against-cost figure.
struct VariantFamily {
  std::string name;
  std::vector<std::string> settings{};  ///< CampaignVariant::settings, along the line; each once

  friend bool operator==(const VariantFamily&, const VariantFamily&) = default;
};

/// The StopCriterion::of that counts the episodes whose true state entered the unsafe set.
inline constexpr const char* kUnsafeEvent = "unsafe";

/// Decides when a campaign has driven enough seeds; see StopRule.
struct StopCriterion {
  std::string of = kUnsafeEvent;  ///< kUnsafeEvent, or outcome_name of an outcome
  double rate_halfwidth = 0.0;    ///< in (0, 0.25]: largest half-width of a variant's interval
  double confidence =
      0.99;  ///< in [0.5, 0.999999], of each variant's interval, at all numbers of seeds

  friend bool operator==(const StopCriterion&, const StopCriterion&) = default;
};

/// "unsafe to +-0.001 at 99 %"; "none" without a criterion.
[[nodiscard]] std::string until_text(const std::optional<StopCriterion>& until);

/// How rare outcomes are searched for.
struct RareSettings {
  SplitSettings splitting{};
  bool certify = true;  ///< whether every drive is certified, for comparison with the certificates
};

/// Every variant is driven with every seed. The same seed gives every variant the same random
/// numbers, so that variants are compared in pairs by seed.
struct Campaign {
  std::string name;
  std::vector<CampaignVariant> variants;  ///< at least one; ordered by scenario, settings, plant
  SeedSet seeds;
  TraceKeeping traces = TraceKeeping::kNone;
  /// With kFailures: the first this many seeds of each variant keep their trace as well.
  std::int64_t trace_sample = 0;
  /// The lines of the risk-against-cost figure; without any there is no such figure.
  std::vector<VariantFamily> risk_against_cost{};
  /// With a criterion, fewer seeds than `seeds` are driven if they suffice.
  std::optional<StopCriterion> until{};
  /// If set, every seed of a variant also estimates the probability that a drive is unsafe, by
  /// splitting with these settings.
  std::optional<RareSettings> rare{};

  /// The maximum number of episodes; `until` may reduce it.
  [[nodiscard]] std::int64_t episodes() const {
    return static_cast<std::int64_t>(variants.size()) * seeds.size();
  }
};

/// "none", "all", or "failures, sample N".
[[nodiscard]] std::string traces_text(const Campaign& campaign);

/// "200 particles, 1 killed, floor 1e-12, certified"; empty if rare outcomes are not searched for.
[[nodiscard]] std::string rare_text(const Campaign& campaign);

}  // namespace qsmpc::harness
