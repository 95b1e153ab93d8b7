#include "harness/prediction/monte_carlo.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <utility>
#include <vector>

#include "controller/regions/unsafe_set.hpp"
#include "harness/threads/workers.hpp"
#include "models/random/random_numbers.hpp"

namespace qsmpc::harness {
namespace {

// Paths that are simulated together: enough for long loops in the dynamics, few enough for the
// cache and for a prompt response to Ctrl-C.
constexpr std::int64_t kBatch = 1024;

/// Simulates batches of paths; the batches are distributed among threads.
class PathSimulation {
 public:
  /// collector: receives every batch; may be null.
  PathSimulation(const controller::PredictedMotion& motion, const controller::SafeSet& safe_set,
                 const MonteCarloOptions& options, PathCollector* collector)
      : motion_(motion),
        unsafe_(safe_set),
        options_(options),
        collector_(collector),
        initial_(motion.belief.mean, motion.belief.covariance),
        noise_(Eigen::VectorXd::Zero(motion.belief.mean.size()), motion.noise_covariance) {}

  /// Takes batches until none are left or the work is abandoned. report: whether to report
  /// progress.
  UnsafeCounts work(bool report) {
    UnsafeCounts counts;
    counts.stages.assign(static_cast<std::size_t>(motion_.policy.horizon()), 0);
    while (!stopped_) {
      const std::int64_t begin = next_.fetch_add(kBatch);
      if (begin >= options_.samples) break;
      if (options_.should_stop && options_.should_stop()) {
        stopped_ = true;
        break;
      }
      const std::int64_t size = std::min(kBatch, options_.samples - begin);
      simulate(begin, size, counts);
      done_ += size;
      if (report && options_.on_progress) options_.on_progress(done_, options_.samples);
    }
    return counts;
  }

  [[nodiscard]] bool stopped() const { return stopped_; }

 private:
  [[nodiscard]] models::RandomKey key(std::int64_t path, Eigen::Index stage) const {
    return {.seed = options_.seed,
            .episode = static_cast<std::uint64_t>(path),
            .stream = models::RandomStream::kPrediction,
            .step = static_cast<std::uint64_t>(stage)};
  }

  void simulate(std::int64_t begin, std::int64_t size, UnsafeCounts& counts) const {
    controller::Points states(motion_.belief.mean.size(), size);
    controller::Points next(states.rows(), size);
    controller::Points inputs(motion_.policy.inputs.rows(), size);
    std::vector<char> was_unsafe(static_cast<std::size_t>(size), 0);
    std::vector<PathCollector::StageSums> sums;
    for (Eigen::Index i = 0; i < size; ++i) states.col(i) = initial_.sample(key(begin + i, 0));
    for (Eigen::Index k = 0; k < motion_.policy.horizon(); ++k) {
      controller::policy_inputs(motion_.policy, k, states, inputs);
      motion_.dynamics.step(states, inputs, next);
      for (Eigen::Index i = 0; i < size; ++i) next.col(i) += noise_.sample(key(begin + i, k + 1));
      states.swap(next);
      counts.stages[static_cast<std::size_t>(k)] += count_unsafe(states, was_unsafe);
      if (collector_ != nullptr) sums.push_back(collector_->collect(k + 1, begin, states));
    }
    if (collector_ != nullptr) collector_->add(begin / kBatch, std::move(sums));
    counts.samples += size;
    counts.any_stage += std::count(was_unsafe.begin(), was_unsafe.end(), 1);
  }

  std::int64_t count_unsafe(const controller::Points& states, std::vector<char>& was_unsafe) const {
    std::int64_t count = 0;
    for (Eigen::Index i = 0; i < states.cols(); ++i) {
      const Eigen::VectorXd state = states.col(i);
      if (state.allFinite() && controller::distance_to_unsafe(state, unsafe_) > 0.0) continue;
      was_unsafe[static_cast<std::size_t>(i)] = 1;
      ++count;
    }
    return count;
  }

  const controller::PredictedMotion& motion_;
  controller::UnsafeSet unsafe_;
  const MonteCarloOptions& options_;
  PathCollector* collector_;
  models::GaussianSampler initial_;
  models::GaussianSampler noise_;
  std::atomic<std::int64_t> next_ = 0;  // first path that no thread has taken
  std::atomic<std::int64_t> done_ = 0;
  std::atomic<bool> stopped_ = false;
};

void add_to(UnsafeCounts& total, const UnsafeCounts& more) {
  total.samples += more.samples;
  total.any_stage += more.any_stage;
  for (std::size_t k = 0; k < total.stages.size(); ++k) total.stages[k] += more.stages[k];
}

/// Simulates all paths, on all threads.
std::optional<UnsafeCounts> run_simulation(const controller::PredictedMotion& motion,
                                           const controller::SafeSet& safe_set,
                                           const MonteCarloOptions& options,
                                           PathCollector* collector) {
  PathSimulation simulation(motion, safe_set, options, collector);
  const int threads = options.threads > 0 ? options.threads : available_threads();
  std::vector<UnsafeCounts> counts(static_cast<std::size_t>(threads));
  run_workers(threads, [&](int worker) {
    const bool reports = worker == 0;  // the calling thread
    counts[static_cast<std::size_t>(worker)] = simulation.work(reports);
  });
  if (simulation.stopped()) return std::nullopt;
  UnsafeCounts total = std::move(counts.front());
  for (std::size_t n = 1; n < counts.size(); ++n) add_to(total, counts[n]);
  // The last batch may have been finished by another thread.
  if (options.on_progress) options.on_progress(total.samples, options.samples);
  return total;
}

}  // namespace

std::optional<UnsafeCounts> simulate_unsafe_counts(const controller::PredictedMotion& motion,
                                                   const controller::SafeSet& safe_set,
                                                   const MonteCarloOptions& options) {
  return run_simulation(motion, safe_set, options, nullptr);
}

std::optional<SimulatedPaths> simulate_paths(const controller::PredictedMotion& motion,
                                             const controller::SafeSet& safe_set,
                                             const MonteCarloOptions& options, std::int64_t kept) {
  PathCollector collector(motion.policy, kept);
  std::optional<UnsafeCounts> counts = run_simulation(motion, safe_set, options, &collector);
  if (!counts) return std::nullopt;
  return SimulatedPaths{.counts = *std::move(counts), .laws = collector.laws(options.samples)};
}

}  // namespace qsmpc::harness
