#include "harness/campaign/shard_source.hpp"

#include <string>

#include "harness/campaign/stopping.hpp"
#include "harness/episode/episode.hpp"

namespace qsmpc::harness {

ShardSource::ShardSource(const Campaign& campaign, const Store& store, const Shard& shard,
                         bool retry_faults)
    : campaign_(campaign),
      store_(store),
      shard_(shard),
      retry_faults_(retry_faults),
      total_(static_cast<std::int64_t>(campaign.variants.size()) *
             shard.share(campaign.seeds.size())),
      seed_end_(campaign.seeds.size()),
      seed_index_(shard.index - 1) {
  if (!campaign.until) return;
  rule_ =
      stop_rule_of(campaign, store, retry_faults ? outcome_name(Outcome::kFault) : std::string());
  stop_where_it_suffices();
}

std::optional<EpisodeTask> ShardSource::next(const std::function<bool()>& stopped) {
  const std::lock_guard lock(next_mutex_);
  while (!stopped() && seed_index_ < seed_end_) {
    const EpisodeTask task{.variant = variant_, .seed_index = seed_index_};
    if (++variant_ == campaign_.variants.size()) {
      variant_ = 0;
      seed_index_ += shard_.count;
    }
    const std::optional<std::string> outcome =
        store_.outcome(store_.variant_ids()[task.variant], campaign_.seeds.at(task.seed_index));
    if (!outcome) return task;
    if (retry_faults_ && *outcome == outcome_name(Outcome::kFault)) {
      return EpisodeTask{.variant = task.variant, .seed_index = task.seed_index, .again = true};
    }
  }
  return std::nullopt;
}

void ShardSource::stored(const EpisodeTask& task, const EpisodeRow& row) {
  const std::lock_guard lock(rule_mutex_);
  if (!rule_) return;
  rule_->add(task.seed_index, task.variant,
             is_stop_event(*campaign_.until, row.outcome, row.unsafe));
  stop_where_it_suffices();
}

/// Once fewer seeds suffice, later ones are neither begun nor, if begun, wanted.
void ShardSource::stop_where_it_suffices() {
  const std::optional<std::int64_t> seeds = rule_->stops_after();
  if (!seeds) return;
  seed_end_ = *seeds;
  total_ = static_cast<std::int64_t>(campaign_.variants.size()) * *seeds;
}

}  // namespace qsmpc::harness
