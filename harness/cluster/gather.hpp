// What the tasks of a campaign have driven, joined in the campaign's own store.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace qsmpc::harness {

struct GatherOptions {
  /// Whether the caller knows that no task is at work. Else tasks that have not said how they ended
  /// are watched for a while.
  bool tasks_have_ended = false;
  /// Told which tasks are watched and for how long at most, s.
  std::function<void(const std::string& tasks, double seconds)> on_watch{};
  /// Called between looks; may throw, e.g. Interrupted.
  std::function<void()> sleep{};
};

struct Gathered {
  std::int64_t episodes = 0;  ///< in the store now
  std::int64_t total = 0;     ///< of the campaign, or of the first seeds that suffice
};

/// Whether all that the campaign in `folder` asks for is in its own store. Throws as StoreReader.
[[nodiscard]] bool is_gathered(const std::string& folder);

/// Joins the stores of all tasks of the campaign in `folder`, and what was gathered before, in its
/// campaign.sqlite, with the traces that are kept. Each episode is taken once, also where several
/// tasks drove it: from what was gathered before, or the first task that has it. Where all are
/// there, this is the store of a campaign that one process drove, timings aside.
///
/// The caller holds the FolderLock of FOLDER/cluster. The tasks' stores stay as they are; that of a
/// task which was killed is completed in a copy. Throws InputError where the folder has no plan, or
/// where two tasks have driven the same episode with different results, which it names; IoError
/// where a task is at work, a store is damaged, or nothing can be written: what was gathered before
/// then stays.
[[nodiscard]] Gathered gather_tasks(const std::string& folder, const GatherOptions& options);

}  // namespace qsmpc::harness
