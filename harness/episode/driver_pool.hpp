// Episode drivers that threads borrow from one another.
#pragma once

#include <cstddef>
#include <list>
#include <mutex>
#include <utility>

#include "harness/episode/episode.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::harness {

/// Keeps drivers that are at rest, so that the next episode of their scenario need not make one.
/// May be used by several threads at the same time.
class DriverPool {
 public:
  /// Keeps at most `limit` drivers at rest; beyond it, the one that has rested longest goes.
  explicit DriverPool(std::size_t limit) : limit_(limit) {}

  /// As run_episode. `scenario` must outlive the pool, at its address, by which it is known.
  [[nodiscard]] Trace run(const Scenario& scenario, const EpisodeOptions& options);

 private:
  [[nodiscard]] EpisodeDriver take(const Scenario& scenario);
  void put_back(const Scenario& scenario, EpisodeDriver driver);

  const std::size_t limit_;
  std::mutex mutex_;                                              // of what follows
  std::list<std::pair<const Scenario*, EpisodeDriver>> resting_;  // the longest first
};

}  // namespace qsmpc::harness
