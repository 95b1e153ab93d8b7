// Decides when a campaign has driven enough seeds.
//
//   StopRule rule(*campaign.until, campaign.variants.size(), campaign.seeds.size());
//   rule.add(seed_index, variant_index, is_stop_event(*campaign.until, outcome, unsafe));
//   if (const auto seeds = rule.stops_after()) …  // the first *seeds of them suffice
//
// It stops after the smallest number n of seeds, in their order, such that the interval of every
// variant's event rate over its first n seeds has at most the requested half-width. Later seeds
// have no effect, so n is the same for any order of additions and thus for any number of jobs,
// machines and interruptions.
//
// Since n depends on the data, the intervals are those of a confidence sequence, which hold for all
// n simultaneously; see docs/theory/stopping.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/statistics/binomial_interval.hpp"

namespace qsmpc::harness {

/// The values of `until.of`: "unsafe" (the true state entered the unsafe set) and the outcomes.
[[nodiscard]] const std::vector<std::string>& stop_event_names();

/// Whether `criterion` counts an episode with this `outcome` and `unsafe` flag.
[[nodiscard]] bool is_stop_event(const StopCriterion& criterion, const std::string& outcome,
                                 bool unsafe);

/// Not thread-safe. Memory grows with the number of seeds ahead of the first incomplete one.
class StopRule {
 public:
  /// seeds: their maximum number, SeedSet::size(). Throws std::invalid_argument without variants.
  StopRule(const StopCriterion& criterion, std::size_t variants, std::int64_t seeds);

  /// Adds the episode of a variant (by its index in the campaign) and seed (by its index in the
  /// seeds). Adding one twice has no effect. Throws std::invalid_argument if an index is out of
  /// range.
  void add(std::int64_t seed_index, std::size_t variant, bool event);

  /// How many first seeds suffice, once known; nothing if the seeds run out first.
  [[nodiscard]] std::optional<std::int64_t> stops_after() const { return stops_after_; }

  /// How many first seeds are complete and counted; at most stops_after().
  [[nodiscard]] std::int64_t complete() const { return complete_; }
  /// The interval of a variant's rate over its complete first seeds.
  [[nodiscard]] RateInterval interval(std::size_t variant) const;

 private:
  enum class Known : char { kNot, kOther, kEvent };

  void take_complete();
  [[nodiscard]] bool is_wide(std::size_t variant) const;

  StopCriterion criterion_;
  std::int64_t seeds_;
  std::vector<std::int64_t> events_;                    ///< of the complete seeds, by variant
  std::map<std::int64_t, std::vector<Known>> ahead_{};  ///< by seed: what is known of each variant
  std::int64_t complete_ = 0;
  std::size_t wide_ = 0;  ///< the last variant found with too wide an interval
  std::optional<std::int64_t> stops_after_{};
};

}  // namespace qsmpc::harness
