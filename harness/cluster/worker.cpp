#include "harness/cluster/worker.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <climits>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

#include <unistd.h>

#include "harness/campaign/runner.hpp"
#include "harness/cluster/launch_file.hpp"
#include "harness/cluster/lease_queue.hpp"
#include "harness/cluster/lease_source.hpp"
#include "harness/cluster/task_report.hpp"
#include "harness/errors.hpp"

namespace qsmpc::harness {
namespace {

using Clock = std::chrono::steady_clock;

// Heartbeats of a holder per `lost_after`, the time after which it is considered lost.
constexpr int kBeats = 8;
constexpr int kLooks = 60;  // polls for leases per `lost_after`

std::string this_host() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 && name[0] != '\0' ? name.data() : "?";
}

LeaseHolder new_holder(const std::string& folder, int task, std::int64_t launch) {
  LeaseHolder holder{.task = task, .launch = launch, .host = this_host(), .process = ::getpid()};
  make_task_folder(folder, holder);
  return holder;
}

class Worker {
 public:
  Worker(const LeasePlan& plan, const std::string& folder, const WorkerOptions& options,
         const TaskLaunch& launch)
      : folder_(folder),
        options_(options),
        period_(std::chrono::duration_cast<Clock::duration>(launch.lost_after) / kBeats),
        holder_(new_holder(folder, options.task, launch.launch)),
        queue_(folder, {.leases = plan.leases(), .me = holder_, .lost_after = launch.lost_after}),
        source_(plan, folder, queue_,
                std::chrono::duration_cast<Clock::duration>(launch.lost_after) / kLooks) {}

  WorkerEnd run(const LeasePlan& plan, const Campaign& campaign) {
    report(TaskWord::kWorking);
    try {
      const std::string own = task_folder(folder_, holder_);
      Store store(own, plan.identity.campaign, plan.identity.variants, plan.seeds, false,
                  StoreUse::kAlone);
      drive(campaign, {.folder = own, .store = store, .source = source_});
      queue_.give_back();
      store.fold();
    } catch (const std::exception& error) {
      give_up(error.what());
      throw;
    }
    report(queue_.all_finished() ? TaskWord::kDone : TaskWord::kStopped);
    return {.all_finished = queue_.all_finished(),
            .episodes = episodes_,
            .seconds = std::chrono::duration<double>(Clock::now() - start_).count()};
  }

 private:
  void drive(const Campaign& campaign, const EpisodeFlow& flow) {
    CampaignOptions options{.jobs = options_.jobs};
    options.should_stop = options_.should_stop;
    options.should_hurry = [this] {
      return source_.has_failed() || (options_.should_hurry && options_.should_hurry());
    };
    options.on_progress = [this](const CampaignProgress& now) { episodes_ = now.fresh; };
    {
      const std::jthread heart([this](const std::stop_token& stop) { beat_until(stop); });
      (void)drive_episodes(campaign, flow, options);
    }
    source_.rethrow_failure();
  }

  /// If it fails, the folder is missing or full: no further episode could be stored, so the run
  /// fails.
  void beat_until(const std::stop_token& stop) {
    try {
      std::mutex mutex;
      std::unique_lock lock(mutex);
      std::condition_variable_any asleep;
      while (!asleep.wait_for(lock, stop, period_, [&stop] { return stop.stop_requested(); })) {
        queue_.beat();
        report(TaskWord::kWorking);
      }
    } catch (...) {
      source_.fail(std::current_exception());
    }
  }

  void report(TaskWord word, const std::string& note = {}) {
    write_task_report(folder_,
                      {.holder = holder_,
                       .word = word,
                       .note = note,
                       .episodes = episodes_,
                       .seconds = std::chrono::duration<double>(Clock::now() - start_).count(),
                       .beat = ++beats_});
  }

  /// Informs other tasks, as far as the folder can still be written. Errors here are dropped: the
  /// original failure is what is thrown.
  void give_up(const std::string& why) noexcept {
    try {
      queue_.give_back();
      report(TaskWord::kFailed, why);
    } catch (const std::exception&) {
      // Other tasks will find out, since this one's heartbeat has stopped.
    }
  }

  const std::string& folder_;
  const WorkerOptions& options_;
  const Clock::duration period_;
  const Clock::time_point start_ = Clock::now();
  const LeaseHolder holder_;
  LeaseQueue queue_;
  LeaseSource source_;
  std::atomic<std::int64_t> episodes_ = 0;
  std::int64_t beats_ = 0;  // only one thread at a time reports
};

}  // namespace

WorkerEnd run_worker(const LeasePlan& plan, const Campaign& campaign, const std::string& folder,
                     const WorkerOptions& options) {
  if (std::ssize(finished_leases(folder)) >= plan.leases()) return {.all_finished = true};
  const TaskLaunch launch = read_task_launch(folder).value_or(TaskLaunch{});
  return Worker(plan, folder, options, launch).run(plan, campaign);
}

}  // namespace qsmpc::harness
