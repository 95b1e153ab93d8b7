// The episodes of the leases that a task claims one after the other.
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

/// Claims the next lease when all episodes of the previous ones have begun, and marks a lease as
/// finished as soon as its last row is stored. If no lease is available, it waits until all leases
/// of the campaign are finished or some holder is lost. If the campaign has a stop rule, the rule
/// is fed with all that any task has finished, and leases beyond the seeds that suffice are not
/// claimed.
class LeaseSource : public EpisodeSource {
 public:
  /// `folder`: the campaign's. `pause`: time between two polls of it while no lease is available.
  /// The references must outlive this object.
  LeaseSource(const LeasePlan& plan, const std::string& folder, LeaseQueue& queue,
              std::chrono::steady_clock::duration pause);

  [[nodiscard]] std::int64_t total() const override { return plan_.episodes(); }
  [[nodiscard]] bool is_wanted(const EpisodeTask& task) const override {
    return task.seed_index < seed_end_;
  }
  /// Throws IoError, and the error passed to `fail`.
  std::optional<EpisodeTask> next(const std::function<bool()>& stopped) override;
  /// Throws IoError.
  void stored(const EpisodeTask& task, const EpisodeRow& row) override;

  /// From now on all calls of `next` throw `error`; the first error counts.
  void fail(std::exception_ptr error);
  [[nodiscard]] bool has_failed() const;
  /// Throws the error passed to `fail`, if any.
  void rethrow_failure() const;

 private:
  /// A lease whose episodes are not all stored yet.
  struct OpenLease {
    std::int64_t begun = 0;   ///< episodes returned by `next`
    std::int64_t stored = 0;  ///< of these, the episodes stored
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
  mutable std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  std::exception_ptr error_;
  Clock::time_point next_look_{};
  std::map<std::int64_t, OpenLease> open_;
  std::optional<StopRule> rule_;
  std::set<std::int64_t> told_;  ///< finished leases already passed to the rule
};

}  // namespace qsmpc::harness
