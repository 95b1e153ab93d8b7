#include "harness/campaign/runner.hpp"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "harness/campaign/stopping.hpp"
#include "harness/campaign/rare/rare_run.hpp"
#include "harness/campaign/store/episode_row.hpp"
#include "harness/campaign/store/folder_lock.hpp"
#include "harness/episode/driver_pool.hpp"
#include "harness/episode/episode.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/plant/plant_registry.hpp"
#include "harness/threads/workers.hpp"
#include "harness/trace/trace_file.hpp"

namespace qsmpc::harness {
namespace {

using Clock = std::chrono::steady_clock;

// Drivers at rest are kept for this many variants, as each takes some megabytes.
constexpr std::size_t kDriversPerJob = 4;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double unix_time() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::vector<std::string> digests_of(const Campaign& campaign) {
  std::vector<std::string> digests;
  std::map<std::string, std::string> known;
  for (const CampaignVariant& variant : campaign.variants) {
    const Scenario::Plant& plant = variant.resolved.plant;
    const auto [entry, is_new] = known.try_emplace(plant.kind + " " + plant.mjcf);
    if (is_new) entry->second = plant_digest(variant.resolved);
    digests.push_back(entry->second);
  }
  return digests;
}

/// An episode to be driven.
struct Task {
  std::size_t variant = 0;      ///< index in the campaign
  std::int64_t seed_index = 0;  ///< in its seeds
  bool again = false;           ///< it is in the store, and is to be replaced
};

class CampaignRun {
 public:
  CampaignRun(const Campaign& campaign, std::string folder, const CampaignOptions& options,
              Store& store)
      : campaign_(campaign),
        folder_(std::move(folder)),
        options_(options),
        store_(store),
        drivers_(kDriversPerJob * static_cast<std::size_t>(options.jobs)),
        seed_index_(options.shard.index - 1),
        seed_end_(campaign.seeds.size()) {
    progress_.total = static_cast<std::int64_t>(campaign.variants.size()) *
                      options.shard.share(campaign.seeds.size());
    progress_.outcomes = store.outcomes();
    for (const auto& [outcome, count] : progress_.outcomes) progress_.done += count;
    if (!campaign.until) return;
    rule_ = stop_rule_of(campaign, store,
                         options.retry_faults ? outcome_name(Outcome::kFault) : std::string());
    stop_where_it_suffices();
  }

  CampaignProgress run() {
    tell();
    run_workers(options_.jobs, [this](int) { work(); });
    progress_.elapsed = seconds_since(start_);
    return progress_;
  }

 private:
  void work() {
    try {
      while (const std::optional<Task> task = next()) drive(*task);
    } catch (...) {
      failed_ = true;  // the others give up, too
      throw;
    }
  }

  [[nodiscard]] bool stopped() const {
    return failed_ || (options_.should_stop && options_.should_stop());
  }

  /// The next episode that is to be driven. All variants of a seed come before the next seed, so
  /// that what is done at any time can be compared in pairs.
  std::optional<Task> next() {
    const std::lock_guard lock(next_mutex_);
    while (!stopped() && seed_index_ < seed_end_) {
      const Task task{.variant = variant_, .seed_index = seed_index_};
      if (++variant_ == campaign_.variants.size()) {
        variant_ = 0;
        seed_index_ += options_.shard.count;
      }
      const std::optional<std::string> outcome =
          store_.outcome(store_.variant_ids()[task.variant], campaign_.seeds.at(task.seed_index));
      if (!outcome) return task;
      if (options_.retry_faults && *outcome == outcome_name(Outcome::kFault)) {
        return Task{.variant = task.variant, .seed_index = task.seed_index, .again = true};
      }
    }
    return std::nullopt;
  }

  void drive(const Task& task) {
    const auto start = Clock::now();
    EpisodeOptions options;
    options.seed = campaign_.seeds.at(task.seed_index);
    options.should_stop = [this, &task] {
      return failed_ || task.seed_index >= seed_end_ ||
             (options_.should_hurry && options_.should_hurry());
    };
    const Trace trace = drivers_.run(campaign_.variants[task.variant].resolved, options);
    // What was cut short says nothing, and will be driven again.
    if (trace.outcome == Outcome::kInterrupted || task.seed_index >= seed_end_) return;
    EpisodeRow row = episode_row(EpisodeView(trace), store_.variant_ids()[task.variant]);
    if (!add_rare(task, row)) return;
    if (keeps_trace(task, row)) keep(trace, row);
    row.timing.wall_ms = 1e3 * seconds_since(start);
    row.timing.finished_at = unix_time();
    store_.add(row, task.again);
    count(row, task);
  }

  /// What the seed says of rare outcomes, where they are looked for; false if interrupted. It takes
  /// as long as many episodes, so that the first wish to stop ends it.
  bool add_rare(const Task& task, EpisodeRow& row) {
    if (!campaign_.rare) return true;
    row.rare = rare_run(campaign_.variants[task.variant].resolved, *campaign_.rare, row.seed,
                        [this, &task] { return stopped() || task.seed_index >= seed_end_; });
    return row.rare.has_value();
  }

  [[nodiscard]] bool keeps_trace(const Task& task, const EpisodeRow& row) const {
    switch (campaign_.traces) {
      case TraceKeeping::kAll:
        return true;
      case TraceKeeping::kNone:
        return false;
      case TraceKeeping::kFailures:
        return is_failure(row) || task.seed_index < campaign_.trace_sample;
    }
    return false;
  }

  /// Writes the trace to the disk, before the row that speaks of it.
  void keep(const Trace& trace, EpisodeRow& row) {
    row.trace = episode_folder(row.variant, row.seed);
    const std::string target = folder_ + "/" + row.trace;
    // The library of the traces' format is not made for several threads.
    const std::lock_guard lock(trace_mutex_);
    make_durable_folder(target, folder_);
    write_trace(target + "/" + kTraceFile, trace);
    write_controller_log(trace, target);
  }

  void count(const EpisodeRow& row, const Task& task) {
    const std::lock_guard lock(mutex_);
    if (task.again) {
      --progress_.outcomes[outcome_name(Outcome::kFault)];
    } else {
      ++progress_.done;
    }
    ++progress_.fresh;
    ++progress_.outcomes[row.outcome];
    if (rule_) {
      rule_->add(task.seed_index, task.variant,
                 is_stop_event(*campaign_.until, row.outcome, row.unsafe));
      stop_where_it_suffices();
    }
    tell();
  }

  /// Begins no episode of seeds beyond those that suffice, and gives up those that have begun.
  void stop_where_it_suffices() {
    const std::optional<std::int64_t> seeds = rule_->stops_after();
    if (!seeds) return;
    seed_end_ = *seeds;
    progress_.total = static_cast<std::int64_t>(campaign_.variants.size()) * *seeds;
  }

  void tell() {
    progress_.elapsed = seconds_since(start_);
    if (options_.on_progress) options_.on_progress(progress_);
  }

  const Campaign& campaign_;
  const std::string folder_;
  const CampaignOptions& options_;
  Store& store_;
  const Clock::time_point start_ = Clock::now();
  DriverPool drivers_;
  std::atomic<bool> failed_ = false;
  std::mutex next_mutex_;  // of what is next
  std::size_t variant_ = 0;
  std::int64_t seed_index_;
  std::atomic<std::int64_t> seed_end_;  ///< no seed from here on is driven
  std::mutex trace_mutex_;
  std::mutex mutex_;  // of what follows
  CampaignProgress progress_;
  std::optional<StopRule> rule_{};
};

}  // namespace

CampaignProgress run_campaign(const Campaign& campaign, const std::string& folder,
                              const CampaignOptions& options) {
  const std::vector<std::string> digests = digests_of(campaign);
  refuse_shard_of_rule(campaign, options.shard);
  make_output_folder(folder);
  const FolderLock lock(folder);
  Store store(folder, stored_campaign(campaign, options.shard), stored_variants(campaign, digests),
              campaign.seeds, options.update);
  remove_traces(folder, store.update().traces);
  if (store.update().changed && options.on_update) options.on_update(store.update());
  CampaignProgress progress = CampaignRun(campaign, folder, options, store).run();
  if (progress.stopped_after = stop_where_known(campaign, store, folder); progress.stopped_after) {
    progress.outcomes = store.outcomes();
    progress.done = progress.total =
        static_cast<std::int64_t>(campaign.variants.size()) * *progress.stopped_after;
  }
  store.fold();
  return progress;
}

}  // namespace qsmpc::harness
