// The environment of experiments: runs scenarios with variations, caches what several experiments
// need, and reports progress.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/parallel.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::harness {

/// A scenario as an experiment runs it.
struct Variant {
  std::string scenario;                  ///< name of a shipped one
  std::vector<std::string> overrides{};  ///< KEY=VALUE
  std::string plant = "analytic";        ///< as `with_plant` takes it
};

/// The scenario of `variant`. Throws InputError.
[[nodiscard]] Scenario scenario_of(const Variant& variant);

/// What is kept of an episode. Each period is a column or an entry.
struct EpisodeDigest {
  std::uint64_t seed = 0;
  bool arrived = false;             ///< it ended at the target, whether safely or not
  bool unsafe = false;              ///< the true state entered the unsafe set
  double duration = 0.0;            ///< of the episode, s of simulated time
  double optimisation_s = 0.0;      ///< wall-clock time of all plans: quantise … optimise
  double cost = 0.0;                ///< Σ ½ |x − r|²_Q + |u|²_R
  double min_clearance = 0.0;       ///< m
  StepTiming timing{};              ///< medians of the periods, ms
  std::vector<double> next_step{};  ///< certificate of the next step
  std::vector<double> particles{};  ///< C1 of the next step
  std::vector<double> published{};  ///< Algorithms 3 and 4 as printed; not a bound
  std::vector<double> plan_risk{};  ///< certificate of the whole plan: sum of its stages', ≤ 1
  std::vector<double> costs{};      ///< expected cost of the plan
  Eigen::MatrixXd states{};         ///< true ones, state_dim x (periods + 1)
  Eigen::MatrixXd inputs{};         ///< input_dim x periods
};

/// Episodes of one variant, for the scenario's seed and the following ones.
struct Sample {
  Scenario scenario;
  std::vector<EpisodeDigest> episodes{};
  Trace first{};  ///< of the first of them
};

/// Thrown when the work is abandoned.
struct Stopped {};

struct LaboratoryOptions {
  int seeds = 20;          ///< ≥ 1, episodes per variant
  int arrival_seeds = 50;  ///< ≥ 1, episodes if only the share that arrives is counted
  int step_limit = 0;      ///< maximum number of periods of a drive; 0: the scenario's
  std::int64_t truth_samples = 4'000'000;  ///< number of paths for estimates of true values
  int threads = 0;                         ///< at most; 0: as many as the processor runs
                                           ///< concurrently
  std::function<bool()> should_stop{};     ///< called by several threads
  std::function<void(const std::string&)>
      on_work{};  ///< called with the current activity, by one thread at a time
};

class Laboratory {
 public:
  explicit Laboratory(LaboratoryOptions options);

  [[nodiscard]] int seeds() const { return options_.seeds; }
  [[nodiscard]] int arrival_seeds() const { return options_.arrival_seeds; }
  [[nodiscard]] std::int64_t truth_samples() const { return options_.truth_samples; }
  [[nodiscard]] int threads() const { return threads_; }
  /// The executor that independent work is divided among.
  [[nodiscard]] const controller::Executor& run() const { return run_; }

  /// `count` episodes of `variant` (`seeds` if it is 0), driven unless they have been before. Each
  /// runs on one thread and, except for timings, depends only on the scenario and its seed. The
  /// reference is valid as long as the laboratory. Throws Stopped, and InputError on an invalid
  /// variant.
  const Sample& sample(const Variant& variant, int count = 0);

  /// Reports the current activity. Throws Stopped if the work is to be abandoned.
  void at_work(const std::string& what) const;

 private:
  [[nodiscard]] bool stopped() const { return options_.should_stop && options_.should_stop(); }

  LaboratoryOptions options_;
  int threads_;
  controller::Executor run_;
  std::map<std::string, Sample> samples_;
};

/// One number per episode.
[[nodiscard]] std::vector<double> over_episodes(
    const Sample& sample, const std::function<double(const EpisodeDigest&)>& number);

/// The number of episodes that reached the target and were never unsafe.
[[nodiscard]] int safe_arrivals(const Sample& sample);

}  // namespace qsmpc::harness
