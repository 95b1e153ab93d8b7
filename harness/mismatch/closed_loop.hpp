// Episodes of one plant in closed loop, and their summary statistics.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/parallel.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/statistics/binomial_interval.hpp"
#include "harness/threads/shared_work.hpp"
#include "harness/trace/episode_view.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// The data kept of an episode.
struct EpisodeResult {
  std::uint64_t seed = 0;
  std::string outcome;
  std::string fault;  ///< the simulator's message; empty without a fault
  int steps = 0;
  bool unsafe = false;         ///< the true state entered the unsafe set
  double min_clearance = 0.0;  ///< m
  double cost = 0.0;           ///< Σ ½ |x − r|²_Q + |u|²_R
  Eigen::MatrixXd residuals;   ///< one_step_residuals, state_dim x periods
  Eigen::VectorXd magnitude;   ///< largest |state|, state_dim
  /// Per period that the plant completed: the certified probability that its end is unsafe, and
  /// whether it was.
  std::vector<double> certified{};
  std::vector<char> unsafe_next{};
};

/// The data that a comparison keeps of an episode.
[[nodiscard]] EpisodeResult episode_result(const EpisodeView& view);

/// Episodes of `scenario` with the seeds seed, seed + 1, …, each a unit of `work`; the result does
/// not depend on `run`. Throws as run_episode. Incomplete if `work` was stopped.
[[nodiscard]] std::vector<EpisodeResult> run_episodes(const Scenario& scenario, int count,
                                                      const controller::Executor& run,
                                                      SharedWork& work);

/// Summary statistics of episodes.
struct ClosedLoop {
  std::int64_t episodes = 0;
  std::map<std::string, std::int64_t> outcomes{};  ///< number of episodes by outcome
  [[nodiscard]] std::int64_t count(Outcome outcome) const;
  double cost = 0.0;             ///< mean
  double cost_deviation = 0.0;   ///< standard error of the mean; not a number for one episode
  double min_clearance = 0.0;    ///< the least over all episodes, m
  std::int64_t unsafe = 0;       ///< episodes that entered the unsafe set
  RateInterval unsafe_limits{};  ///< Clopper–Pearson, 99 %
  std::int64_t periods = 0;
  std::int64_t unsafe_periods = 0;  ///< periods that ended in the unsafe set
  double certified_periods = 0.0;   ///< sum of the certified probabilities of all periods
  /// From `exceedance_p_value`: small if more periods ended unsafe than the certificates allow.
  double p_value = 1.0;
};

/// episodes: at least one, else throws std::invalid_argument. The p-value is that of PeriodTallies.
[[nodiscard]] ClosedLoop closed_loop_of(const std::vector<EpisodeResult>& episodes);

}  // namespace qsmpc::harness
