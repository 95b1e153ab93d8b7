#include "harness/mismatch/closed_loop.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "harness/episode/driver_pool.hpp"
#include "harness/episode/episode.hpp"
#include "harness/mismatch/horizon_comparison.hpp"
#include "harness/statistics/exceedance.hpp"
#include "harness/statistics/sample_statistics.hpp"
#include "harness/trace/rows.hpp"

namespace qsmpc::harness {
namespace {

PeriodTallies tallies_of(const std::vector<EpisodeResult>& episodes) {
  PeriodTallies tallies;
  for (const EpisodeResult& episode : episodes) {
    const std::size_t periods = episode.certified.size();
    for (std::size_t k = 0; k < periods; ++k) {
      tallies.add(static_cast<std::int64_t>(k), episode.certified[k], episode.unsafe_next[k] != 0);
    }
    if (periods > 0) {
      tallies.end_episode(static_cast<std::int64_t>(periods), episode.certified.back());
    }
  }
  return tallies;
}

}  // namespace

std::int64_t ClosedLoop::count(Outcome outcome) const {
  const auto found = outcomes.find(outcome_name(outcome));
  return found == outcomes.end() ? 0 : found->second;
}

EpisodeResult episode_result(const EpisodeView& view) {
  const Trace& trace = view.trace();
  const Summary& summary = view.summary();
  EpisodeResult result{.seed = trace.seed,
                       .outcome = summary.outcome,
                       .fault = trace.fault,
                       .steps = summary.steps,
                       .unsafe = summary.collision,
                       .min_clearance = summary.min_clearance,
                       .cost = summary.closed_loop_cost,
                       .residuals = view.residuals(),
                       .magnitude = Eigen::VectorXd::Zero(std::ssize(view.system().states))};
  const Eigen::MatrixXd& states = view.states();
  if (states.cols() > 0) result.magnitude = states.cwiseAbs().rowwise().maxCoeff();
  for (Eigen::Index k = 0; k < result.residuals.cols(); ++k) {
    const StepRecord& step = trace.steps[static_cast<std::size_t>(k)];
    if (step.certificates.empty()) continue;
    result.certified.push_back(step.certificates.front().value);
    result.unsafe_next.push_back(view.ended_unsafe(k));
  }
  return result;
}

std::vector<EpisodeResult> run_episodes(const Scenario& scenario, int count,
                                        const controller::Executor& run, SharedWork& work) {
  std::vector<EpisodeResult> results(static_cast<std::size_t>(count));
  DriverPool drivers(static_cast<std::size_t>(count));
  run(count, [&](int n) {
    if (work.stopped()) return;
    EpisodeOptions options;
    options.seed = scenario.seed + static_cast<std::uint64_t>(n);
    options.should_stop = [&work] { return work.stopped(); };
    results[static_cast<std::size_t>(n)] =
        episode_result(EpisodeView(drivers.run(scenario, options)));
    work.advance();
  });
  return results;
}

ClosedLoop closed_loop_of(const std::vector<EpisodeResult>& episodes) {
  if (episodes.empty()) throw std::invalid_argument("closed loop: no episodes");
  ClosedLoop loop{.episodes = std::ssize(episodes),
                  .min_clearance = std::numeric_limits<double>::infinity()};
  for (const EpisodeResult& episode : episodes) {
    ++loop.outcomes[episode.outcome];
    loop.min_clearance = std::min(loop.min_clearance, episode.min_clearance);
    loop.unsafe += episode.unsafe ? 1 : 0;
    loop.periods += std::ssize(episode.certified);
    loop.unsafe_periods += std::ranges::count(episode.unsafe_next, 1);
    for (const double probability : episode.certified) loop.certified_periods += probability;
  }
  const std::vector<double> costs = column_of(episodes, &EpisodeResult::cost);
  loop.cost = mean_of_shares(costs);
  loop.cost_deviation = standard_error_about(costs, loop.cost);
  loop.unsafe_limits = clopper_pearson(loop.unsafe, loop.episodes, kIntervalTail);
  loop.p_value = exceedance_p_value(tallies_of(episodes).tallies());
  return loop;
}

}  // namespace qsmpc::harness
