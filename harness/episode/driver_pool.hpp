// A pool of episode drivers that threads share.
#pragma once

#include <cstddef>
#include <list>
#include <mutex>
#include <utility>

#include "harness/episode/episode.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::harness {

/// Keeps idle drivers, so that the next episode of their scenario need not make one. May be used by
/// several threads simultaneously.
class DriverPool {
 public:
  /// Keeps at most `limit` idle drivers; beyond that, the one idle for longest is destroyed.
  explicit DriverPool(std::size_t limit) : limit_(limit) {}

  /// As run_episode. `scenario` must outlive the pool at the same address, which identifies it.
  [[nodiscard]] Trace run(const Scenario& scenario, const EpisodeOptions& options);

 private:
  [[nodiscard]] EpisodeDriver take(const Scenario& scenario);
  void put_back(const Scenario& scenario, EpisodeDriver driver);

  const std::size_t limit_;
  std::mutex mutex_;                                              // protects the following members
  std::list<std::pair<const Scenario*, EpisodeDriver>> resting_;  // the longest idle first
};

}  // namespace qsmpc::harness
