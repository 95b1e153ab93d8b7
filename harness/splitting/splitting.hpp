// Adaptive multilevel splitting: estimates the probability of a rare event of random paths. Many
// paths are simulated; those that stayed furthest from the event are killed and replaced by
// branches of paths that came nearer, with new noise from the branch point on. The estimate is
// unbiased for any number of paths (Bréhier, Gazeau, Goudenège, Lelièvre, Rousset: "Unbiasedness of
// some generalized adaptive multilevel splitting algorithms", Annals of Applied Probability 26,
// 2016); docs/theory/splitting.md derives it.
//
//   const std::optional<SplitRun> run =
//       split({.particles = 200}, seed, [&](const PathSeeds& seeds, bool) { return drive(seeds);
//       });
//
// A path is a function of its seeds. A branch is simulated from the start, with the same seeds up
// to the branch point and a new one from there on, so that no state has to be copied.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <vector>

#include "models/random/noise_seeds.hpp"

namespace qsmpc::harness {

/// The seeds that determine a path.
struct PathSeeds {
  std::uint64_t seed = 0;  ///< < 2⁶³, for every draw of the path not covered by `noise`
  std::vector<models::NoiseSeed> noise{};  ///< of its noise from given instants on, ascending

  friend bool operator==(const PathSeeds&, const PathSeeds&) = default;
};

/// A simulated path, as splitting uses it.
struct SplitPath {
  PathSeeds seeds{};
  /// How near it is to the event at instants 0, 1, …: above 0 exactly where the event occurs. There
  /// is at least one level and none is NaN; a path may end at the first level above 0.
  std::vector<double> levels{};
  int kind = 0;        ///< for the caller's use
  double value = 0.0;  ///< its mean over all paths is estimated
};

struct SplitSettings {
  int particles = 200;  ///< ≥ 2, size of the population
  int killed = 1;       ///< 1 … particles − 1, killed per level; ties are killed with them
  /// ≥ 0: a run ends with the paths that it has once its estimate can only be below this.
  double floor = 1e-12;
};

struct SplitRun {
  double probability = 0.0;  ///< the estimate
  /// An unbiased estimate of the mean of SplitPath::value, event or not.
  double value = 0.0;
  std::int64_t levels = 0;          ///< levels at which paths were killed
  std::int64_t paths = 0;           ///< paths simulated, the first ones included
  std::int64_t instants = 0;        ///< instants simulated in them, repeated ones included
  bool extinct = false;             ///< all paths were killed at one level: the estimate is 0
  bool below_floor = false;         ///< ended at the floor: the estimate is nearly always 0
  std::int64_t first_events = 0;    ///< among the first paths: `particles` plain ones
  std::int64_t first_instants = 0;  ///< instants simulated in the first paths
  /// The final paths that have the event, each with an equal share of `probability`; duplicates are
  /// possible.
  std::vector<SplitPath> events{};
};

/// Simulates the path of these seeds; `is_first` says whether it is one of the first paths. Returns
/// nothing if it was stopped.
using DrivePath = std::function<std::optional<SplitPath>(const PathSeeds& seeds, bool is_first)>;

/// A path was simulated again with the same seeds up to an instant and differs up to there: it
/// depends on more than its seeds.
class PathNotRepeated : public std::runtime_error {
 public:
  explicit PathNotRepeated(std::size_t instant);
  /// The first instant at which it differs.
  [[nodiscard]] std::size_t instant() const { return instant_; }

 private:
  std::size_t instant_;
};

/// One run. All its random numbers derive from `seed`, which is also the seed of its first path.
/// Returns nothing if `drive` did. Throws std::invalid_argument on settings or paths that violate
/// the conditions above, PathNotRepeated, and whatever `drive` throws.
[[nodiscard]] std::optional<SplitRun> split(const SplitSettings& settings, std::uint64_t seed,
                                            const DrivePath& drive);

}  // namespace qsmpc::harness
