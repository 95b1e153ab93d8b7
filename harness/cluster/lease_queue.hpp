// Assigns the leases of a campaign to tasks, using only files in a folder that the machines share.
//
// A claim is a file that only one task can create. A task that takes a lease over creates the file
// of the next generation, so that no file in use is ever removed or renamed. The holder increments
// a counter in its claim; if it does not change for a while, by the observer's clock, the holder is
// considered lost. Clocks of different machines are never compared. A holder that was merely slow
// continues: episodes are the same whichever task drives them, and are gathered once.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace qsmpc::harness {

/// A task at work.
struct LeaseHolder {
  int task = 0;             ///< its number, from 1
  int start = 1;            ///< number of its starts so far
  std::int64_t launch = 0;  ///< the launch of all tasks that it belongs to; higher is later
  std::string host{};
  long process = 0;

  /// "TASK-START", the name of its folder; unique among holders.
  [[nodiscard]] std::string name() const { return fmt::format("{}-{}", task, start); }

  friend bool operator==(const LeaseHolder&, const LeaseHolder&) = default;
};

/// The contents of a claim.
struct LeaseClaim {
  std::int64_t lease = 0;
  std::int64_t generation = 0;
  LeaseHolder holder{};
  bool given_back = false;
};

/// The latest claim of each claimed, unfinished lease in the campaign's `folder`. Claims that are
/// being written are skipped. Throws IoError.
[[nodiscard]] std::vector<LeaseClaim> open_claims(const std::string& folder);

/// The finished leases. Throws IoError.
[[nodiscard]] std::set<std::int64_t> finished_leases(const std::string& folder);

/// The outcomes of one seed's episodes, by variant in the campaign's order.
struct SeedOutcomes {
  std::int64_t seed_index = 0;  ///< index in the campaign's seeds
  std::vector<std::string> outcomes{};
  std::vector<bool> unsafe{};

  friend bool operator==(const SeedOutcomes&, const SeedOutcomes&) = default;
};

/// The outcomes of a finished lease's episodes, by seed. Throws IoError if they cannot be read.
[[nodiscard]] std::vector<SeedOutcomes> finished_outcomes(const std::string& folder,
                                                          std::int64_t lease);

/// One task's view of the leases. Thread-safe. All members throw IoError if the folder cannot be
/// read or written.
class LeaseQueue {
 public:
  using Clock = std::chrono::steady_clock;

  struct Options {
    std::int64_t leases = 1;
    LeaseHolder me{};
    /// A lease is taken over after this time without a sign of its holder.
    Clock::duration lost_after = std::chrono::seconds(120);
    /// This process's clock, replaceable by tests.
    std::function<Clock::time_point()> now = Clock::now;
  };

  /// `folder`: the campaign's folder, which has a plan.
  LeaseQueue(std::string folder, Options options);

  /// Claims a lease: the first that was never claimed, else one that was given back or whose holder
  /// is lost or belongs to an earlier launch or an earlier start of this task. Nothing if none is
  /// available at the moment.
  [[nodiscard]] std::optional<std::int64_t> claim();

  /// From now on only the first `leases` leases are claimed and have to be finished.
  void need(std::int64_t leases);

  /// Whether all needed leases were finished at the last `claim`.
  [[nodiscard]] bool all_finished() const;

  /// Marks the lease as finished. To be called once the rows of all its episodes are on disk.
  void finish(std::int64_t lease, const std::vector<SeedOutcomes>& outcomes);

  /// Releases all leases that this task holds, for other tasks.
  void give_back();

  /// Shows that this task, which holds its leases, is alive. To be called several times within
  /// `lost_after`.
  void beat();

 private:
  struct Watch {
    std::int64_t generation = 0;
    std::string content{};
    Clock::time_point since{};
  };

  [[nodiscard]] std::optional<std::int64_t> claim_fresh();
  [[nodiscard]] std::optional<std::int64_t> claim_again();
  [[nodiscard]] bool is_lost(std::int64_t lease, std::int64_t generation);
  [[nodiscard]] bool take(std::int64_t lease, std::int64_t generation);
  void write_held(std::int64_t lease, bool given_back);

  const std::string folder_;
  const Options options_;
  mutable std::mutex mutex_;                         // guards the members below
  std::optional<std::set<std::int64_t>> claimed_{};  // by any task, at the first look
  std::int64_t needed_;
  std::int64_t next_fresh_ = 0;
  std::int64_t beats_ = 0;
  std::map<std::int64_t, std::int64_t> held_{};  // generations
  std::map<std::int64_t, Watch> watched_{};
  bool all_finished_ = false;
};

}  // namespace qsmpc::harness
