// When a campaign has driven enough seeds.
//
//   StopRule rule(*campaign.until, campaign.variants.size(), campaign.seeds.size());
//   rule.add(seed_index, variant_index, is_stop_event(*campaign.until, outcome, unsafe));
//   if (const auto seeds = rule.stops_after()) …  // the first *seeds of them suffice
//
// It stops after the first number n of seeds, in their order, such that every variant's rate of the
// event over its first n seeds has an interval of at most the half-width that is asked for. What is
// known of later seeds changes nothing, so that n is the same for any order of additions: for any
// number of jobs, machines and interruptions.
//
// n depends on what happened. The intervals are those of a confidence sequence, which hold for all
// n at once; see docs/theory/stopping.md.
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

/// What `until.of` may be: "unsafe" (the true state entered the unsafe set) and the outcomes.
[[nodiscard]] const std::vector<std::string>& stop_event_names();

/// Whether an episode that ended with `outcome` is counted by `criterion`.
[[nodiscard]] bool is_stop_event(const StopCriterion& criterion, const std::string& outcome,
                                 bool unsafe);

/// Not to be used by several threads at once. Memory grows with the number of seeds that are ahead
/// of the first one that is not complete.
class StopRule {
 public:
  /// seeds: at most this many, SeedSet::size(). Throws std::invalid_argument without a variant.
  StopRule(const StopCriterion& criterion, std::size_t variants, std::int64_t seeds);

  /// The episode of a variant (its place in the campaign) with a seed (its place in the seeds).
  /// Adding one a second time changes nothing. Throws std::invalid_argument on places that there
  /// are none of.
  void add(std::int64_t seed_index, std::size_t variant, bool event);

  /// How many first seeds suffice, once that is known. It is never known of fewer than all seeds
  /// where the limit of the seeds comes first.
  [[nodiscard]] std::optional<std::int64_t> stops_after() const { return stops_after_; }

  /// How many first seeds are complete, and count; at most stops_after().
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
  std::map<std::int64_t, std::vector<Known>> ahead_{};  ///< by seed, what is known of each variant
  std::int64_t complete_ = 0;
  std::size_t wide_ = 0;  ///< the variant whose interval was too wide the last time
  std::optional<std::int64_t> stops_after_{};
};

}  // namespace qsmpc::harness
