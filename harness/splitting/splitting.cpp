#include "harness/splitting/splitting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "models/random/random_numbers.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kEventLevel = 0.0;  // the levels of a path without the event are at most this

struct Particle {
  SplitPath path{};
  double most = 0.0;  // the maximum of its levels
};

double most_of(const SplitPath& path) {
  if (path.levels.empty() ||
      std::ranges::any_of(path.levels, [](double level) { return std::isnan(level); })) {
    throw std::invalid_argument(
        "splitting: a path without levels, or with a level that is not a number");
  }
  return std::ranges::max(path.levels);
}

/// The first instant at which the path is above `level`; there must be one.
std::size_t first_above(const SplitPath& path, double level) {
  const auto found = std::ranges::find_if(path.levels, [&](double at) { return at > level; });
  return static_cast<std::size_t>(found - path.levels.begin());
}

/// The seeds of `parent` before `instant`, and `seed` from that instant on.
PathSeeds branched(const PathSeeds& parent, std::size_t instant, std::uint64_t seed) {
  PathSeeds seeds{.seed = parent.seed};
  for (const models::NoiseSeed& entry : parent.noise) {
    if (entry.from < instant) seeds.noise.push_back(entry);
  }
  seeds.noise.push_back({.from = instant, .seed = seed});
  return seeds;
}

void require_repeated(const SplitPath& parent, const SplitPath& child, std::size_t instant) {
  for (std::size_t at = 0; at <= instant; ++at) {
    if (at >= child.levels.size() || child.levels[at] != parent.levels[at]) {
      throw PathNotRepeated(at);
    }
  }
}

class Splitting {
 public:
  Splitting(const SplitSettings& settings, std::uint64_t seed, const DrivePath& drive)
      : settings_(settings), seed_(seed), drive_(drive) {}

  std::optional<SplitRun> run() {
    if (!draw_first()) return std::nullopt;
    while (true) {
      const double level = lowest_level();
      if (level > kEventLevel) break;
      if (share_ < settings_.floor) {
        run_.below_floor = true;
        break;
      }
      if (!raise(level)) return std::nullopt;
      if (run_.extinct) return std::move(run_);
    }
    finish();
    return std::move(run_);
  }

 private:
  /// Two random words for particle `place` of a generation; generation 0 is that of the first
  /// paths.
  [[nodiscard]] std::array<std::uint64_t, 2> words(std::uint64_t generation,
                                                   std::size_t place) const {
    std::array<std::uint64_t, 2> drawn{};
    models::random_words({.seed = seed_,
                          .episode = generation,
                          .stream = models::RandomStream::kSplitting,
                          .step = place},
                         drawn);
    return drawn;
  }

  [[nodiscard]] static std::uint64_t seed_of(std::uint64_t word) { return word >> 1U; }

  [[nodiscard]] std::optional<Particle> driven(const PathSeeds& seeds, bool is_first) {
    std::optional<SplitPath> path = drive_(seeds, is_first);
    if (!path) return std::nullopt;
    path->seeds = seeds;
    const double most = most_of(*path);
    ++run_.paths;
    run_.instants += std::ssize(path->levels) - 1;
    return Particle{.path = std::move(*path), .most = most};
  }

  bool draw_first() {
    for (std::size_t n = 0; n < static_cast<std::size_t>(settings_.particles); ++n) {
      std::optional<Particle> particle =
          driven({.seed = n == 0 ? seed_ : seed_of(words(0, n)[0])}, true);
      if (!particle) return false;
      if (particle->most > kEventLevel) ++run_.first_events;
      particles_.push_back(std::move(*particle));
    }
    run_.first_instants = run_.instants;
    return true;
  }

  /// The `killed`-th smallest maximum: at least `killed` paths never exceed it.
  [[nodiscard]] double lowest_level() const {
    std::vector<double> levels;
    levels.reserve(particles_.size());
    for (const Particle& particle : particles_) levels.push_back(particle.most);
    const auto lowest = levels.begin() + (settings_.killed - 1);
    std::ranges::nth_element(levels, lowest);
    return *lowest;
  }

  /// Kills the paths that never exceed `level` and replaces them by branches of the others. Returns
  /// false if it was stopped.
  bool raise(double level) {
    std::vector<std::size_t> given_up;
    std::vector<std::size_t> parents;
    for (std::size_t n = 0; n < particles_.size(); ++n) {
      (particles_[n].most > level ? parents : given_up).push_back(n);
    }
    ++run_.levels;
    for (const std::size_t n : given_up) run_.value += weight() * particles_[n].path.value;
    if (parents.empty()) {
      run_.extinct = true;
      return true;
    }
    share_ *= static_cast<double>(parents.size()) / static_cast<double>(particles_.size());
    for (const std::size_t n : given_up) {
      // The modulo bias towards any parent is at most 2⁻⁴⁰.
      const auto [which, seed] = words(static_cast<std::uint64_t>(run_.levels), n);
      std::optional<Particle> child =
          branch(particles_[parents[which % parents.size()]], level, seed_of(seed));
      if (!child) return false;
      particles_[n] = std::move(*child);
    }
    return true;
  }

  [[nodiscard]] std::optional<Particle> branch(const Particle& parent, double level,
                                               std::uint64_t seed) {
    const std::size_t instant = first_above(parent.path, level);
    // A path that ends here draws nothing more: its branch would be a copy.
    if (instant + 1 == parent.path.levels.size()) return parent;
    std::optional<Particle> child = driven(branched(parent.path.seeds, instant, seed), false);
    if (child) require_repeated(parent.path, child->path, instant);
    return child;
  }

  /// The probability that each particle represents.
  [[nodiscard]] double weight() const { return share_ / static_cast<double>(particles_.size()); }

  void finish() {
    for (Particle& particle : particles_) {
      run_.value += weight() * particle.path.value;
      if (particle.most > kEventLevel) run_.events.push_back(std::move(particle.path));
    }
    run_.probability = weight() * static_cast<double>(run_.events.size());
  }

  const SplitSettings& settings_;
  const std::uint64_t seed_;
  const DrivePath& drive_;
  std::vector<Particle> particles_{};
  double share_ = 1.0;  // the probability that the current particles represent
  SplitRun run_{};
};

}  // namespace

PathNotRepeated::PathNotRepeated(std::size_t instant)
    : std::runtime_error("a path driven again with the same seeds differs at instant " +
                         std::to_string(instant)),
      instant_(instant) {}

std::optional<SplitRun> split(const SplitSettings& settings, std::uint64_t seed,
                              const DrivePath& drive) {
  if (settings.particles < 2 || settings.killed < 1 || settings.killed >= settings.particles ||
      !(settings.floor >= 0.0)) {
    throw std::invalid_argument("splitting: invalid settings");
  }
  return Splitting(settings, seed, drive).run();
}

}  // namespace qsmpc::harness
