// Who drives which lease of a campaign: files in a folder that machines share, and nothing else.
//
// A claim is a file that only one can make. Whoever takes a lease over makes the file of the next
// generation, so that no file is ever removed or renamed from under anybody. The holder counts up a
// number in its claim; where it does not change for a while, by the clock of whoever looks, the
// holder is lost. No two clocks are ever compared. A holder that was only slow drives on: episodes
// are the same whoever drives them, and are gathered once.
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
  int start = 1;            ///< how often the task was started by then
  std::int64_t launch = 0;  ///< the start of all tasks that it belongs to; higher is later
  std::string host{};
  long process = 0;

  /// "TASK-START", the name of its folder; of no two holders the same.
  [[nodiscard]] std::string name() const { return fmt::format("{}-{}", task, start); }

  friend bool operator==(const LeaseHolder&, const LeaseHolder&) = default;
};

/// What a claim says.
struct LeaseClaim {
  std::int64_t lease = 0;
  std::int64_t generation = 0;
  LeaseHolder holder{};
  bool given_back = false;
};

/// The latest claim of each lease in the campaign's `folder` that has one and is not finished.
/// Claims that are being written are left out. Throws IoError.
[[nodiscard]] std::vector<LeaseClaim> open_claims(const std::string& folder);

/// The leases that are finished. Throws IoError.
[[nodiscard]] std::set<std::int64_t> finished_leases(const std::string& folder);

/// How one seed's episodes ended, by variant in the campaign's order.
struct SeedOutcomes {
  std::int64_t seed_index = 0;  ///< in the campaign's seeds
  std::vector<std::string> outcomes{};
  std::vector<bool> unsafe{};

  friend bool operator==(const SeedOutcomes&, const SeedOutcomes&) = default;
};

/// How the episodes of a finished lease ended, by seed. Throws IoError where it cannot be read.
[[nodiscard]] std::vector<SeedOutcomes> finished_outcomes(const std::string& folder,
                                                          std::int64_t lease);

/// One task's view of the leases. May be used by several threads at once. All members throw IoError
/// where the folder cannot be read or written.
class LeaseQueue {
 public:
  using Clock = std::chrono::steady_clock;

  struct Options {
    std::int64_t leases = 1;
    LeaseHolder me{};
    /// After how long without a sign of its holder a lease is taken over.
    Clock::duration lost_after = std::chrono::seconds(120);
    /// This process's clock; tests have their own.
    std::function<Clock::time_point()> now = Clock::now;
  };

  /// `folder`: the campaign's, with a plan.
  LeaseQueue(std::string folder, Options options);

  /// Takes a lease: the first that nobody had, else one that was given back, or whose holder is
  /// lost, or belongs to an earlier launch, or to an earlier start of this task. Nothing where
  /// there is none at the moment.
  [[nodiscard]] std::optional<std::int64_t> claim();

  /// From now on only the first `leases` are given out, and have to be finished.
  void need(std::int64_t leases);

  /// Whether all leases that are needed are finished, as of the last `claim`.
  [[nodiscard]] bool all_finished() const;

  /// To be called once the rows of all of the lease's episodes are on the disk.
  void finish(std::int64_t lease, const std::vector<SeedOutcomes>& outcomes);

  /// Lets others have all leases that this task holds.
  void give_back();

  /// Shows that the holder of this task's leases is there. To be called several times within
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
  mutable std::mutex mutex_;                         // of what follows
  std::optional<std::set<std::int64_t>> claimed_{};  // by anybody, at the first look
  std::int64_t needed_;
  std::int64_t next_fresh_ = 0;
  std::int64_t beats_ = 0;
  std::map<std::int64_t, std::int64_t> held_{};  // generations
  std::map<std::int64_t, Watch> watched_{};
  bool all_finished_ = false;
};

}  // namespace qsmpc::harness
