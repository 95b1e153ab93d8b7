// The episodes of a shard that are missing from its store.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/episode_source.hpp"
#include "harness/campaign/statistics/stop_rule.hpp"
#include "harness/campaign/store/store.hpp"

namespace qsmpc::harness {

/// All variants of a seed come before the next seed, so that the episodes done can be compared in
/// pairs at any time. If the campaign has a stop rule, seeds beyond those that suffice are not
/// wanted.
class ShardSource : public EpisodeSource {
 public:
  /// `retry_faults`: episodes that faulted are driven again. The references outlive it.
  ShardSource(const Campaign& campaign, const Store& store, const Shard& shard, bool retry_faults);

  [[nodiscard]] std::int64_t total() const override { return total_; }
  std::optional<EpisodeTask> next(const std::function<bool()>& stopped) override;
  [[nodiscard]] bool is_wanted(const EpisodeTask& task) const override {
    return task.seed_index < seed_end_;
  }
  void stored(const EpisodeTask& task, const EpisodeRow& row) override;

 private:
  void stop_where_it_suffices();

  const Campaign& campaign_;
  const Store& store_;
  const Shard shard_;
  const bool retry_faults_;
  std::atomic<std::int64_t> total_;
  std::atomic<std::int64_t> seed_end_;  // no seed from here on is driven
  std::mutex next_mutex_;               // guards variant_ and seed_index_
  std::size_t variant_ = 0;
  std::int64_t seed_index_;
  std::mutex rule_mutex_;
  std::optional<StopRule> rule_{};
};

}  // namespace qsmpc::harness
