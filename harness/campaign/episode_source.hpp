// The episodes of a campaign that a run drives, and their order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "harness/campaign/store/episode_row.hpp"

namespace qsmpc::harness {

/// An episode to drive.
struct EpisodeTask {
  std::size_t variant = 0;      ///< index in the campaign
  std::int64_t seed_index = 0;  ///< index in the campaign's seeds
  bool again = false;           ///< it is already in the store and is to be replaced
};

/// Thread-safe.
class EpisodeSource {
 public:
  virtual ~EpisodeSource() = default;

  /// The number of episodes in its scope, including those in the store; decreases once fewer
  /// suffice.
  [[nodiscard]] virtual std::int64_t total() const = 0;

  /// The next episode to drive, or nothing if none is left or `stopped` returns true. `stopped` is
  /// called first. The call may block until an episode becomes available, polling `stopped`.
  virtual std::optional<EpisodeTask> next(const std::function<bool()>& stopped) = 0;

  /// Whether an episode returned by `next` is still wanted; called while it is being driven.
  [[nodiscard]] virtual bool is_wanted(const EpisodeTask& task) const = 0;

  /// Called once the row of an episode returned by `next` is on disk.
  virtual void stored(const EpisodeTask& task, const EpisodeRow& row) = 0;
};

}  // namespace qsmpc::harness
