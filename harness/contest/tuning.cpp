#include "harness/contest/tuning.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "harness/campaign/store/episode_row.hpp"
#include "harness/contest/contest_plan.hpp"
#include "harness/statistics/quantiles.hpp"

namespace qsmpc::harness {
namespace {

/// The mean of the finite values; NaN if there are none.
double finite_mean(const std::vector<double>& values) {
  RunningMean mean;
  for (const double value : values) {
    if (std::isfinite(value)) mean.add(value);
  }
  return mean.mean();
}

/// The results of one controller's `count` candidates: contenders `first` … of `contenders`.
std::vector<TriedCandidate> tried_of(const Contest& contest, const StoreReader& search,
                                     const std::vector<Contender>& contenders, std::size_t first,
                                     std::size_t count) {
  std::vector<TriedCandidate> tried(count);
  std::vector<std::vector<double>> relative(count);  // by candidate, one number per cell
  for (const ContestCell& cell : contest.cells()) {
    std::vector<double> costs(count);
    for (std::size_t n = 0; n < count; ++n) {
      TriedCandidate& candidate = tried[n];
      candidate.candidate = contenders[first + n].candidate;
      RunningMean cost;
      const std::size_t variant = variant_of(contest, contenders.size(), first + n, cell);
      search.for_each_episode(search.variants()[variant].id, [&](const EpisodeRow& row) {
        ++candidate.drives;
        if (contest.risk_limit ? !is_certified_within(row, *contest.risk_limit) : is_failure(row)) {
          ++candidate.failures;
        }
        if (!is_failure(row) && std::isfinite(row.cost)) {
          cost.add(row.cost);
        }
      });
      costs[n] = cost.mean();
    }
    const double unit = finite_mean(costs);
    for (std::size_t n = 0; n < count; ++n) {
      // If all costs are 0, all candidates are equal.
      relative[n].push_back(unit == 0.0 ? 1.0 : costs[n] / unit);
    }
  }
  for (std::size_t n = 0; n < count; ++n) tried[n].relative_cost = finite_mean(relative[n]);
  return tried;
}

}  // namespace

std::string failure_words(const Contest& contest) {
  if (!contest.risk_limit) return "unsafe or not arrived";
  return fmt::format("unsafe, not arrived or certified above {:g}", *contest.risk_limit);
}

std::string tuning_criterion(const Contest& contest) {
  return "fewest drives that were unsafe or did not reach the target" +
         (contest.risk_limit
              ? fmt::format(" or were certified above {:g} in total", *contest.risk_limit)
              : "") +
         ", then the lowest mean cost of those that reached it, relative, for each scenario, plant "
         "and noise level, to the mean over the controller's candidates";
}

std::size_t best_candidate(const std::vector<TriedCandidate>& tried) {
  const auto key = [](const TriedCandidate& candidate) {
    const bool has_none = std::isnan(candidate.relative_cost);
    return std::tuple(candidate.failures, has_none, has_none ? 0.0 : candidate.relative_cost);
  };
  return std::ranges::min_element(tried, {}, key)->candidate;
}

TuningResult untuned(const Contest& contest) {
  return {.tried = std::vector<std::vector<TriedCandidate>>(contest.controllers.size()),
          .choice = ContestChoice(contest.controllers.size(), 0)};
}

TuningResult tuned(const Contest& contest, const StoreReader& search) {
  TuningResult result = untuned(contest);
  const std::vector<Contender> contenders = searched_contenders(contest);
  for (std::size_t first = 0; first < contenders.size();) {
    const std::size_t controller = contenders[first].controller;
    const std::size_t count = contest.controllers[controller].candidates.size();
    result.tried[controller] = tried_of(contest, search, contenders, first, count);
    result.choice[controller] = best_candidate(result.tried[controller]);
    first += count;
  }
  return result;
}

}  // namespace qsmpc::harness
