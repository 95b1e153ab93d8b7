// Which episodes of a campaign a run drives, and in which order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "harness/campaign/store/episode_row.hpp"

namespace qsmpc::harness {

/// An episode to be driven.
struct EpisodeTask {
  std::size_t variant = 0;      ///< index in the campaign
  std::int64_t seed_index = 0;  ///< in its seeds
  bool again = false;           ///< it is in the store, and is to be replaced
};

/// Used by several threads at once.
class EpisodeSource {
 public:
  virtual ~EpisodeSource() = default;

  /// Episodes that it is about, those in the store included; fewer once fewer suffice.
  [[nodiscard]] virtual std::int64_t total() const = 0;

  /// The next episode to be driven, or nothing when none is left or `stopped`, which it asks first,
  /// returns true. It may wait for one, and then asks again and again.
  virtual std::optional<EpisodeTask> next(const std::function<bool()>& stopped) = 0;

  /// Whether an episode that `next` gave out is still to be driven; asked while it is.
  [[nodiscard]] virtual bool is_wanted(const EpisodeTask& task) const = 0;

  /// Told once the row of an episode that `next` gave out is on the disk.
  virtual void stored(const EpisodeTask& task, const EpisodeRow& row) = 0;
};

}  // namespace qsmpc::harness
