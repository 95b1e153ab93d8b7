#include "harness/cluster/gather.hpp"

#include <chrono>
#include <filesystem>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/campaign/stopping.hpp"
#include "harness/campaign/store/merge.hpp"
#include "harness/campaign/store/store.hpp"
#include "harness/campaign/store/store_reader.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/cluster/launch_file.hpp"
#include "harness/cluster/lease_plan.hpp"
#include "harness/cluster/task_report.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRecoveredFolder = "recovered";
constexpr const char* kEpisodesFolder = "episodes";
constexpr const char* kLogEnding = "-wal";

void throw_for(const std::string& path, const std::error_code& error) {
  if (error) throw IoError(printable(path, 400) + ": " + error.message());
}

bool is_there(const std::string& path) {
  std::error_code error;
  const bool there = fs::exists(path, error);
  throw_for(path, error);
  return there;
}

std::string names_of(const std::vector<TaskReport>& tasks) {
  std::vector<std::string> names;
  names.reserve(tasks.size());
  for (const TaskReport& task : tasks) {
    names.push_back(fmt::format("{} (process {} on {})", task.holder.task, task.holder.process,
                                printable(task.holder.host)));
  }
  return fmt::format("{} {}", names.size() == 1 ? "task" : "tasks", fmt::join(names, ", "));
}

/// Refuses to gather while tasks are writing.
void refuse_working(const std::string& folder, const std::vector<TaskReport>& reports,
                    const GatherOptions& options) {
  if (options.tasks_have_ended) return;
  const TaskLaunch launch = read_task_launch(folder).value_or(TaskLaunch{});
  const std::vector<TaskReport> suspects = maybe_working(reports, launch.launch);
  if (suspects.empty()) return;
  if (options.on_watch) {
    options.on_watch(names_of(suspects), std::chrono::duration<double>(launch.lost_after).count());
  }
  const auto working = found_working(folder, suspects, launch.lost_after, options.sleep);
  if (working.empty()) return;
  throw IoError(
      printable(folder, 400) + ": " + names_of(working) + (working.size() == 1 ? " is" : " are") +
      " still running; gather after the end of all tasks, or stop them with qsmpc campaign cancel");
}

/// A folder of copied stores, removed on destruction.
class RecoveredStores {
 public:
  explicit RecoveredStores(const std::string& folder)
      : path_(cluster_path(folder, kRecoveredFolder)) {
    clear();
  }
  RecoveredStores(const RecoveredStores&) = delete;
  RecoveredStores& operator=(const RecoveredStores&) = delete;
  ~RecoveredStores() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }

  /// Completes a copy of a store whose writer was killed; returns its folder. Its traces are those
  /// of `task`, by a link.
  std::string recover(const std::string& task, const LeasePlan& plan) {
    std::string copy = path_ + "/" + fs::path(task).filename().string();
    std::error_code error;
    fs::create_directories(copy, error);
    throw_for(copy, error);
    for (const char* ending : {"", kLogEnding}) {
      const std::string from = fmt::format("{}/{}{}", task, kStoreFile, ending);
      const std::string to = fmt::format("{}/{}{}", copy, kStoreFile, ending);
      if (!is_there(from)) continue;
      fs::copy_file(from, to, error);
      throw_for(to, error);
    }
    if (is_there(task + "/" + kEpisodesFolder)) {
      fs::create_symlink(fs::absolute(task) / kEpisodesFolder, copy + "/" + kEpisodesFolder, error);
      throw_for(copy, error);
    }
    Store(copy, plan.identity.campaign, plan.identity.variants, plan.seeds, false, StoreUse::kAlone)
        .fold();
    return copy;
  }

 private:
  void clear() {
    std::error_code error;
    fs::remove_all(path_, error);
    throw_for(path_, error);
  }

  std::string path_;
};

std::int64_t done_of(const StoreReader& store) {
  std::int64_t done = 0;
  for (const auto& [outcome, count] : store.outcomes()) done += count;
  return done;
}

}  // namespace

bool is_gathered(const std::string& folder) {
  if (!is_there(folder + "/" + kStoreFile)) return false;
  const StoreReader store(folder);
  return done_of(store) == store.campaign().episodes;
}

Gathered gather_tasks(const std::string& folder, const GatherOptions& options) {
  const LeasePlan plan = read_lease_plan(folder);
  const bool has_store = is_there(folder + "/" + kStoreFile);
  if (has_store) {
    const StoreReader store(folder);
    refuse_other_campaign(folder, {store.campaign(), store.variants()}, plan.identity,
                          ", according to its task plan");
    const std::int64_t total = store.campaign().episodes;
    if (done_of(store) == total) return {.episodes = total, .total = total};
  }
  const std::vector<TaskReport> reports = task_reports(folder);
  refuse_working(folder, reports, options);
  RecoveredStores recovered(folder);
  std::vector<std::string> stores;
  if (has_store) stores.push_back(folder);
  for (const TaskReport& report : reports) {
    const std::string own = task_folder(folder, report.holder);
    if (!is_there(own + "/" + kStoreFile)) continue;
    const bool has_ended = report.word == TaskWord::kDone || report.word == TaskWord::kStopped;
    const bool is_whole = has_ended && !is_there(own + "/" + kStoreFile + kLogEnding);
    stores.push_back(is_whole ? own : recovered.recover(own, plan));
  }
  if (stores.empty()) {
    throw InputError({.file = folder,
                      .found = "no task that has started",
                      .expected = "tasks that have run; qsmpc campaign resume starts some"});
  }
  const MergeResult merged =
      merge_stores(stores, folder, {.duplicates = true, .incomplete = true, .replace = true});
  Gathered gathered{.episodes = merged.episodes, .total = plan.episodes()};
  if (!plan.identity.campaign.until) return gathered;
  Store store(folder, plan.identity.campaign, plan.identity.variants, plan.seeds, false,
              StoreUse::kAlone);
  const Campaign campaign = campaign_outline(plan);
  if (const auto seeds = stop_where_known(campaign, store, folder)) {
    gathered.episodes = gathered.total = std::ssize(campaign.variants) * *seeds;
  }
  store.fold();
  return gathered;
}

}  // namespace qsmpc::harness
