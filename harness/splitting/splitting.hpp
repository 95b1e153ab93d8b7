// The probability of a rare event of random paths, by adaptive multilevel splitting: many paths are
// driven, those that came least near to the event are given up, and paths that came nearer take
// their place, with other noise from where they did. The estimate is unbiased for any number of
// paths (Bréhier, Gazeau, Goudenège, Lelièvre, Rousset: "Unbiasedness of some generalized adaptive
// multilevel splitting algorithms", Annals of Applied Probability 26, 2016);
// docs/theory/splitting.md derives it.
//
//   const std::optional<SplitRun> run =
//       split({.particles = 200}, seed, [&](const PathSeeds& seeds, bool) { return drive(seeds);
//       });
//
// A path is a function of its seeds. It is branched by driving it again, with the same seeds below
// the branch and another one from there on, so that no state has to be copied.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <vector>

#include "models/random/noise_seeds.hpp"

namespace qsmpc::harness {

/// What a path is driven from.
struct PathSeeds {
  std::uint64_t seed = 0;                  ///< below 2⁶³, of all that the path draws but for
  std::vector<models::NoiseSeed> noise{};  ///< its noise from these instants on, ascending

  friend bool operator==(const PathSeeds&, const PathSeeds&) = default;
};

/// A path as splitting sees it.
struct SplitPath {
  PathSeeds seeds{};
  /// How near it is to the event at its instants 0, 1, …; above 0 exactly where the event is there.
  /// At least one, none not a number; a path may end at the first that is above 0.
  std::vector<double> levels{};
  int kind = 0;        ///< the caller's
  double value = 0.0;  ///< of which the mean is wanted
};

struct SplitSettings {
  int particles = 200;  ///< ≥ 2, paths that are kept
  int killed = 1;  ///< 1 … particles − 1, given up at a time, and all others at their level
  /// ≥ 0: a run whose estimate can only be below it ends with the paths that it has.
  double floor = 1e-12;
};

struct SplitRun {
  double probability = 0.0;  ///< the estimate
  /// An unbiased estimate of the mean of SplitPath::value, event or not.
  double value = 0.0;
  std::int64_t levels = 0;          ///< that paths were given up at
  std::int64_t paths = 0;           ///< driven, the first ones included
  std::int64_t instants = 0;        ///< driven in them, what was driven again included
  bool extinct = false;             ///< all paths were at one level: the estimate is 0
  bool below_floor = false;         ///< ended at the floor: the estimate is nearly always 0
  std::int64_t first_events = 0;    ///< of the first paths, which are `particles` plain ones
  std::int64_t first_instants = 0;  ///< driven in these
  /// The paths that have the event at the end, each of which stands for the same share of
  /// `probability`; several of them may be the same.
  std::vector<SplitPath> events{};
};

/// Drives the path of these seeds; the flag says whether it is one of the first. Nothing where it
/// was told to stop.
using DrivePath = std::function<std::optional<SplitPath>(const PathSeeds& seeds, bool is_first)>;

/// A path that was driven again with the same seeds below an instant is another one before it: it
/// depends on more than its seeds.
class PathNotRepeated : public std::runtime_error {
 public:
  explicit PathNotRepeated(std::size_t instant);
  /// The first instant at which it is another one.
  [[nodiscard]] std::size_t instant() const { return instant_; }

 private:
  std::size_t instant_;
};

/// One run, all random numbers of which come from `seed`; its first path has that seed itself.
/// Nothing where `drive` returned nothing. Throws std::invalid_argument on settings or paths that
/// are not as said above, PathNotRepeated, and what `drive` throws.
[[nodiscard]] std::optional<SplitRun> split(const SplitSettings& settings, std::uint64_t seed,
                                            const DrivePath& drive);

}  // namespace qsmpc::harness
