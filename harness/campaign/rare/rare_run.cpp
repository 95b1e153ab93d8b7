#include "harness/campaign/rare/rare_run.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "controller/regions/unsafe_part.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "harness/episode/episode.hpp"
#include "harness/errors.hpp"
#include "harness/trace/trace.hpp"
#include "harness/trace/true_places.hpp"

namespace qsmpc::harness {
namespace {

/// What follows the first unsafe instant is irrelevant.
Scenario ended_when_unsafe(Scenario scenario) {
  scenario.stop_when_unsafe = true;
  return scenario;
}

/// Simulates drives of a scenario as paths and counts the faults of the first ones.
class LevelDrives {
 public:
  LevelDrives(const Scenario& scenario, bool certify, const std::function<bool()>& should_stop)
      : scenario_(ended_when_unsafe(scenario)),
        certify_(certify),
        should_stop_(should_stop),
        driver_(scenario_) {}

  std::optional<SplitPath> drive(const PathSeeds& seeds, bool is_first) {
    const Trace trace = driver_.run({.seed = seeds.seed,
                                     .noise = seeds.noise,
                                     .certify = certify_,
                                     .should_stop = should_stop_});
    if (trace.outcome == Outcome::kInterrupted) return std::nullopt;
    if (is_first && trace.outcome == Outcome::kFault) ++faults_;
    return SplitPath{.levels = levels_of(trace),
                     .kind = static_cast<int>(trace.outcome),
                     .value = certified_of(trace)};
  }

  /// Number of first drives that faulted.
  [[nodiscard]] std::int64_t faults() const { return faults_; }

 private:
  /// The level at control instant `k` of the drive; `unsafe` is that drive's unsafe set.
  [[nodiscard]] static double level_of(const Eigen::Ref<const Eigen::VectorXd>& state,
                                       const controller::UnsafeSet& unsafe, Eigen::Index k) {
    if (controller::unsafe_part(state, unsafe, k) != controller::UnsafePart::kNone) {
      return std::numeric_limits<double>::infinity();
    }
    return std::min(0.0, -controller::clearance(state, unsafe, k));
  }

  /// The levels at the control instants that the plant reached.
  [[nodiscard]] std::vector<double> levels_of(const Trace& trace) const {
    const controller::UnsafeSet unsafe(driven_safe_set(trace));
    const Eigen::MatrixXd states = true_states(trace);
    const Eigen::Index count = std::min(states.cols(), completed_periods(trace) + 1);
    std::vector<double> levels;
    levels.reserve(static_cast<std::size_t>(count));
    for (Eigen::Index k = 0; k < count; ++k) levels.push_back(level_of(states.col(k), unsafe, k));
    return levels;
  }

  [[nodiscard]] double certified_of(const Trace& trace) const {
    double sum = 0.0;
    if (!certify_) return sum;
    for (const StepRecord& step : trace.steps) sum += step.certificates.front().value;
    return sum;
  }

  const Scenario scenario_;
  const bool certify_;
  const std::function<bool()>& should_stop_;
  EpisodeDriver driver_;
  std::int64_t faults_ = 0;
};

RareDrive found_drive(const SplitPath& path) {
  return {.seeds = path.seeds,
          .outcome = outcome_name(static_cast<Outcome>(path.kind)),
          .periods = std::ssize(path.levels) - 1};
}

/// Up to kMostFound distinct drives that became unsafe.
std::vector<RareDrive> found_drives(const SplitRun& run) {
  std::vector<RareDrive> found;
  for (const SplitPath& path : run.events) {
    if (found.size() == kMostFound) break;
    RareDrive drive = found_drive(path);
    if (std::ranges::find(found, drive) == found.end()) found.push_back(std::move(drive));
  }
  return found;
}

/// The part of the estimate due to drives with `outcome`.
double part_of(const SplitRun& run, Outcome outcome) {
  if (run.events.empty()) return 0.0;
  const auto part = std::ranges::count(run.events, static_cast<int>(outcome), &SplitPath::kind);
  return run.probability * static_cast<double>(part) / static_cast<double>(run.events.size());
}

}  // namespace

std::optional<RareRow> rare_run(const Scenario& scenario, const RareSettings& settings,
                                std::uint64_t seed, const std::function<bool()>& should_stop) {
  LevelDrives drives(scenario, settings.certify, should_stop);
  std::optional<SplitRun> run;
  try {
    run = split(settings.splitting, seed, [&](const PathSeeds& seeds, bool is_first) {
      return drives.drive(seeds, is_first);
    });
  } catch (const PathNotRepeated& error) {
    throw InputError(
        {.key = "rare",
         .found = fmt::format("a drive of {}, seed {}, that differs from control instant {} on "
                              "when it is driven again",
                              scenario.name, seed, error.instant()),
         .expected = "a plant and a controller that behave identically for the same seed: no "
                     "deadline, no random numbers except those from the seed"});
  }
  if (!run) return std::nullopt;
  return RareRow{.particles = settings.splitting.particles,
                 .floor = settings.splitting.floor,
                 .probability = run->probability,
                 .collision = part_of(*run, Outcome::kCollision),
                 .left_bounds = part_of(*run, Outcome::kLeftBounds),
                 .levels = run->levels,
                 .drives = run->paths,
                 .periods = run->instants,
                 .extinct = run->extinct,
                 .below_floor = run->below_floor,
                 .plain_unsafe = run->first_events,
                 .plain_periods = run->first_instants,
                 .plain_faults = drives.faults(),
                 .certified = settings.certify ? run->value : kNotANumber,
                 .found = found_drives(*run)};
}

Scenario with_seeds(Scenario scenario, const PathSeeds& seeds) {
  scenario.seed = seeds.seed;
  scenario.disturbance.seeds = seeds.noise;
  return scenario;
}

}  // namespace qsmpc::harness
