#include "harness/contest/standings.hpp"

#include <cmath>
#include <stdexcept>

#include "harness/contest/contest_plan.hpp"
#include "harness/contest/standing_tally.hpp"
#include "harness/scenario/certificate_scope.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {
namespace {

MatchResult by_sign(const ShareDifference& difference, bool more_is_better) {
  if (difference.p_value >= kContestLevel) return MatchResult::kTie;
  return (difference.higher > difference.lower) == more_is_better ? MatchResult::kWin
                                                                  : MatchResult::kLoss;
}

/// Pools the times of the timed drives of several variants.
class TimesTally {
 public:
  void add(const StoreReader& store, std::int64_t variant) {
    store.for_each_episode(variant,
                           [&](const EpisodeRow& row) { late_ += row.timing.deadline_misses; });
    store.for_each_ocp_ms(variant, [&](double ms) { times_.push_back(ms); });
  }
  [[nodiscard]] ContestTimes result() const {
    return {.periods = static_cast<std::int64_t>(times_.size()),
            .late = late_,
            .ocp_ms = distribution_or_zeros(times_)};
  }

 private:
  std::int64_t late_ = 0;
  std::vector<double> times_{};
};

/// All tallies of a controller.
struct Tallies {
  explicit Tallies(const Contest& contest) : standing(contest.risk_limit) {}

  StandingTally standing;
  VersusTally versus{};
  TimesTally times{};
};

std::string no_bound_of(const StoredVariant& variant) {
  return why_no_bound(
      parse_scenario(variant.scenario_text, {.file = variant.name, .files_must_exist = false}));
}

class Evaluation {
 public:
  Evaluation(const Contest& contest, const StoreReader& drives, const StoreReader* timed)
      : contest_(contest),
        drives_(drives),
        timed_(timed),
        overall_(contest.controllers.size(), Tallies(contest)) {}

  void add_cells(ContestResults& results) {
    std::size_t number = 0;
    for (const ContestCell& cell : contest_.cells()) {
      CellStandings standings{.cell = cell, .name = contest_.name_of(cell)};
      for (std::size_t n = 0; n < contest_.controllers.size(); ++n) {
        standings.standings.push_back(standing_of(cell, number, n));
        results.done += standings.standings.back().drives;
      }
      results.cells.push_back(std::move(standings));
      ++number;
    }
    for (std::size_t n = 0; n < overall_.size(); ++n) {
      results.overall.push_back(result_of(overall_[n], n));
      Standing& standing = results.overall.back();
      for (const CellStandings& cell : results.cells) {
        if (standing.no_bound.empty()) standing.no_bound = cell.standings[n].no_bound;
      }
      // Costs on different maps are not comparable, so a mean over them is meaningless.
      if (results.cells.size() > 1) standing.cost = {.drives = standing.cost.drives};
    }
  }

 private:
  [[nodiscard]] const StoredVariant& variant_in(const StoreReader& store, const ContestCell& cell,
                                                std::size_t controller) const {
    return store.variants().at(variant_of(contest_, contest_.controllers.size(), controller, cell));
  }

  [[nodiscard]] Standing result_of(const Tallies& tallies, std::size_t controller) const {
    Standing standing = tallies.standing.result();
    standing.times = tallies.times.result();
    if (controller != contest_.reference) standing.versus = tallies.versus.result();
    return standing;
  }

  Standing standing_of(const ContestCell& cell, std::size_t number, std::size_t controller) {
    const StoredVariant& variant = variant_in(drives_, cell, controller);
    Tallies own(contest_);
    Tallies& all = overall_[controller];
    drives_.for_each_episode(variant.id, [&](const EpisodeRow& row) {
      poisson_weights(row.seed, weights_);
      own.standing.add(row, weights_);
      all.standing.add(row, weights_);
    });
    if (controller != contest_.reference) {
      const StoredVariant& reference = variant_in(drives_, cell, contest_.reference);
      drives_.for_each_pair(reference.id, variant.id,
                            [&](const EpisodeRow& before, const EpisodeRow& row) {
                              poisson_weights(row.seed, weights_);
                              own.versus.add(before, row, number, weights_);
                              all.versus.add(before, row, number, weights_);
                            });
    }
    if (timed_ != nullptr) {
      const std::int64_t id = variant_in(*timed_, cell, controller).id;
      own.times.add(*timed_, id);
      all.times.add(*timed_, id);
    }
    Standing standing = result_of(own, controller);
    standing.no_bound = no_bound_of(variant);
    return standing;
  }

  const Contest& contest_;
  const StoreReader& drives_;
  const StoreReader* timed_;
  std::vector<Tallies> overall_;
  Eigen::ArrayXd weights_{};
};

}  // namespace

const char* match_result_name(MatchResult result) {
  switch (result) {
    case MatchResult::kWin:
      return "win";
    case MatchResult::kTie:
      return "tie";
    case MatchResult::kLoss:
      return "loss";
  }
  throw std::invalid_argument("match result: a value that has no name");
}

MatchResult Versus::arrival() const { return by_sign(reached, true); }

MatchResult Versus::safety() const { return by_sign(unsafe, false); }

MatchResult Versus::economy() const {
  if (cost.pairs < kFewestPairs) return MatchResult::kTie;
  if (cost.ratio_interval.upper < 1.0) return MatchResult::kWin;
  if (cost.ratio_interval.lower > 1.0) return MatchResult::kLoss;
  return MatchResult::kTie;
}

ContestResults contest_results(const Contest& contest, const TuningResult& tuning,
                               const StoreReader& drives, const StoreReader* timed) {
  ContestResults results{.contest = contest,
                         .version = drives.campaign().version,
                         .tuning = tuning,
                         .asked = drives.campaign().episodes,
                         .timed = timed != nullptr};
  Evaluation(contest, drives, timed).add_cells(results);
  return results;
}

CellCounts cell_counts(const ContestResults& results, std::size_t controller,
                       MatchResult (Versus::*by)() const) {
  CellCounts counts;
  for (const CellStandings& cell : results.cells) {
    const std::optional<Versus>& versus = cell.standings[controller].versus;
    if (!versus) continue;
    const MatchResult result = ((*versus).*by)();
    counts.wins += result == MatchResult::kWin ? 1 : 0;
    counts.ties += result == MatchResult::kTie ? 1 : 0;
    counts.losses += result == MatchResult::kLoss ? 1 : 0;
  }
  return counts;
}

}  // namespace qsmpc::harness
