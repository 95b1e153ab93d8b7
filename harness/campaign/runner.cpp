#include "harness/campaign/runner.hpp"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "harness/campaign/rare/rare_run.hpp"
#include "harness/campaign/shard_source.hpp"
#include "harness/campaign/stopping.hpp"
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

// Idle drivers are kept for at most this many variants per job: each takes several megabytes.
constexpr std::size_t kDriversPerJob = 4;

// Maximum delay between a stop signal reaching a controller's process and reaching this one.
constexpr std::chrono::milliseconds kSignalsApart{500};
constexpr std::chrono::milliseconds kLook{10};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double unix_time() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

class CampaignRun {
 public:
  CampaignRun(const Campaign& campaign, const EpisodeFlow& flow, const CampaignOptions& options)
      : campaign_(campaign),
        folder_(flow.folder),
        options_(options),
        store_(flow.store),
        source_(flow.source),
        drivers_(kDriversPerJob * static_cast<std::size_t>(options.jobs)) {
    progress_.total = source_.total();
    progress_.outcomes = store_.outcomes();
    for (const auto& [outcome, count] : progress_.outcomes) progress_.done += count;
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
      while (const std::optional<EpisodeTask> task = next()) drive(*task);
    } catch (...) {
      failed_ = true;  // makes the other threads stop
      throw;
    }
  }

  [[nodiscard]] bool stopped() const {
    return failed_ || (options_.should_stop && options_.should_stop());
  }

  std::optional<EpisodeTask> next() {
    return source_.next([this] { return stopped(); });
  }

  void drive(const EpisodeTask& task) {
    const auto start = Clock::now();
    EpisodeOptions options;
    options.seed = campaign_.seeds.at(task.seed_index);
    options.should_stop = [this, &task] {
      return failed_ || !source_.is_wanted(task) ||
             (options_.should_hurry && options_.should_hurry());
    };
    const Trace trace = drivers_.run(campaign_.variants[task.variant].resolved, options);
    // An episode that was cut short is discarded; if still needed, it will be driven again.
    if (trace.outcome == Outcome::kInterrupted || !source_.is_wanted(task)) return;
    if (ended_with_its_controller(trace)) return;
    EpisodeRow row = episode_row(EpisodeView(trace), store_.variant_ids()[task.variant]);
    if (!add_rare(task, row)) return;
    if (keeps_trace(task, row)) keep(trace, row);
    row.timing.wall_ms = 1e3 * seconds_since(start);
    row.timing.finished_at = unix_time();
    store_.add(row, task.again);
    source_.stored(task, row);
    count(row, task);
  }

  /// Adds the seed's estimate of rare outcomes, if these are searched for; false if interrupted. It
  /// takes as long as many episodes, so the first request to stop interrupts it.
  bool add_rare(const EpisodeTask& task, EpisodeRow& row) {
    if (!campaign_.rare) return true;
    row.rare = rare_run(campaign_.variants[task.variant].resolved, *campaign_.rare, row.seed,
                        [this, &task] { return stopped() || !source_.is_wanted(task); });
    return row.rare.has_value();
  }

  /// Whether the controller failed because of a stop signal to all processes of a job, as sent by
  /// Slurm, that reached an external controller before this process.
  [[nodiscard]] bool ended_with_its_controller(const Trace& trace) const {
    if (trace.outcome != Outcome::kFault || trace.fault_of != FaultOf::kController) return false;
    const auto until = Clock::now() + kSignalsApart;
    while (!stopped() && Clock::now() < until) std::this_thread::sleep_for(kLook);
    return stopped();
  }

  [[nodiscard]] bool keeps_trace(const EpisodeTask& task, const EpisodeRow& row) const {
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

  /// Writes the trace to disk before the row that refers to it.
  void keep(const Trace& trace, EpisodeRow& row) {
    row.trace = episode_folder(row.variant, row.seed);
    const std::string target = folder_ + "/" + row.trace;
    // The trace format's library is not thread-safe.
    const std::lock_guard lock(trace_mutex_);
    make_durable_folder(target, folder_);
    write_trace(target + "/" + kTraceFile, trace);
    write_controller_log(trace, target);
  }

  void count(const EpisodeRow& row, const EpisodeTask& task) {
    const std::lock_guard lock(mutex_);
    if (task.again) {
      --progress_.outcomes[outcome_name(Outcome::kFault)];
    } else {
      ++progress_.done;
    }
    ++progress_.fresh;
    ++progress_.outcomes[row.outcome];
    progress_.total = source_.total();
    tell();
  }

  void tell() {
    progress_.elapsed = seconds_since(start_);
    if (options_.on_progress) options_.on_progress(progress_);
  }

  const Campaign& campaign_;
  const std::string folder_;
  const CampaignOptions& options_;
  Store& store_;
  EpisodeSource& source_;
  const Clock::time_point start_ = Clock::now();
  DriverPool drivers_;
  std::atomic<bool> failed_ = false;
  std::mutex trace_mutex_;
  std::mutex mutex_;  // guards the members below
  CampaignProgress progress_;
};

}  // namespace

std::vector<std::string> plant_digests(const Campaign& campaign) {
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

CampaignProgress drive_episodes(const Campaign& campaign, const EpisodeFlow& flow,
                                const CampaignOptions& options) {
  return CampaignRun(campaign, flow, options).run();
}

CampaignProgress run_campaign(const Campaign& campaign, const std::string& folder,
                              const CampaignOptions& options) {
  const std::vector<std::string> digests = plant_digests(campaign);
  refuse_shard_of_rule(campaign, options.shard);
  make_output_folder(folder);
  const FolderLock lock(folder);
  Store store(folder, stored_campaign(campaign, options.shard), stored_variants(campaign, digests),
              campaign.seeds, options.update);
  remove_traces(folder, store.update().traces);
  if (store.update().changed && options.on_update) options.on_update(store.update());
  ShardSource source(campaign, store, options.shard, options.retry_faults);
  CampaignProgress progress =
      drive_episodes(campaign, {.folder = folder, .store = store, .source = source}, options);
  if (progress.stopped_after = stop_where_known(campaign, store, folder); progress.stopped_after) {
    progress.outcomes = store.outcomes();
    progress.done = progress.total =
        static_cast<std::int64_t>(campaign.variants.size()) * *progress.stopped_after;
  }
  store.fold();
  return progress;
}

}  // namespace qsmpc::harness
