// The episodes of the leases that a task takes, one lease after the other.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/campaign/episode_source.hpp"
#include "harness/campaign/statistics/stop_rule.hpp"
#include "harness/cluster/lease_plan.hpp"
#include "harness/cluster/lease_queue.hpp"

namespace qsmpc::harness {

/// Takes the next lease when all episodes of those before are begun, and says that one is finished
/// as soon as its last row is stored. Where nothing can be taken, it waits until all leases of the
/// campaign are finished, or some holder is lost. Where the campaign has a rule that stops it, the
/// rule is told of all that any task has finished, and leases beyond the seeds that suffice are not
/// taken.
class LeaseSource : public EpisodeSource {
 public:
  /// `folder`: the campaign's. `pause`: between two looks at it while nothing can be taken. The
  /// references outlive it.
  LeaseSource(const LeasePlan& plan, const std::string& folder, LeaseQueue& queue,
              std::chrono::steady_clock::duration pause);

  [[nodiscard]] std::int64_t total() const override { return plan_.episodes(); }
  [[nodiscard]] bool is_wanted(const EpisodeTask& task) const override {
    return task.seed_index < seed_end_;
  }
  /// Throws IoError, and what `fail` was told.
  std::optional<EpisodeTask> next(const std::function<bool()>& stopped) override;
  /// Throws IoError.
  void stored(const EpisodeTask& task, const EpisodeRow& row) override;

  /// Makes all calls of `next` throw `error`, from now on.
  void fail(std::exception_ptr error);
  [[nodiscard]] bool has_failed() const;
  /// Throws what `fail` was told, if it was called.
  void rethrow_failure() const;

 private:
  /// A lease of which not all episodes are stored.
  struct OpenLease {
    std::int64_t begun = 0;   ///< episodes that were given out
    std::int64_t stored = 0;  ///< of these
    std::vector<SeedOutcomes> seeds{};
  };

  [[nodiscard]] std::optional<EpisodeTask> next_of_open();
  void open(std::int64_t lease);
  void ask_rule();

  using Clock = std::chrono::steady_clock;
  const LeasePlan& plan_;
  const std::string& folder_;
  LeaseQueue& queue_;
  std::atomic<std::int64_t> seed_end_;  // no seed from here on is driven
  const Clock::duration pause_;
  mutable std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  std::exception_ptr error_;
  Clock::time_point next_look_{};
  std::map<std::int64_t, OpenLease> open_;
  std::optional<StopRule> rule_;
  std::set<std::int64_t> told_;  ///< finished leases that the rule was told of
};

}  // namespace qsmpc::harness
