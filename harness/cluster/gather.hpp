// Merges the episodes that the tasks of a campaign have driven into the campaign's own store.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace qsmpc::harness {

struct GatherOptions {
  /// Whether the caller knows that no task is at work. Otherwise tasks that have not reported their
  /// end are watched for a while.
  bool tasks_have_ended = false;
  /// Called with the tasks that are watched and the maximum duration, s.
  std::function<void(const std::string& tasks, double seconds)> on_watch{};
  /// Called between polls; may throw, e.g. Interrupted.
  std::function<void()> sleep{};
};

struct Gathered {
  std::int64_t episodes = 0;  ///< now in the store
  std::int64_t total = 0;     ///< episodes of the campaign, or of the first seeds that suffice
};

/// Whether all episodes of the campaign in `folder` are in its own store. Throws as StoreReader.
[[nodiscard]] bool is_gathered(const std::string& folder);

/// Merges the stores of all tasks of the campaign in `folder`, and the episodes gathered before,
/// into its campaign.sqlite, with the kept traces. Each episode is taken once, even if several
/// tasks drove it: from the episodes gathered before, or from the first task that has it. When
/// complete, the store equals that of a campaign driven by one process, except for timings.
///
/// The caller holds the FolderLock of FOLDER/cluster. The tasks' stores are not modified; that of a
/// killed task is completed in a copy. Throws InputError if the folder has no plan, or if two tasks
/// have driven the same episode with different results, naming the episode; IoError if a task is at
/// work, a store is damaged, or the result cannot be written. What was gathered before is then
/// kept.
[[nodiscard]] Gathered gather_tasks(const std::string& folder, const GatherOptions& options);

}  // namespace qsmpc::harness
