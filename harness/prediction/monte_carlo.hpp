// How often the model is unsafe under a policy, estimated by simulation: a check of the
// certificates that shares only the model with them.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "controller/prediction/prediction.hpp"
#include "controller/regions/safe_set.hpp"
#include "harness/prediction/path_collector.hpp"

namespace qsmpc::harness {

/// The numbers of unsafe paths among the simulated ones.
struct UnsafeCounts {
  std::int64_t samples = 0;
  std::vector<std::int64_t> stages;  ///< at stage 1 … horizon
  std::int64_t any_stage = 0;        ///< at one or more of them
};

struct MonteCarloOptions {
  std::uint64_t seed = 0;
  std::int64_t samples = 0;
  int threads = 0;  ///< 0: as many as the processor runs concurrently
  /// Called between batches, by several threads; true abandons the work.
  std::function<bool()> should_stop{};
  /// Called with the number of paths done and their total, by the calling thread.
  std::function<void(std::int64_t, std::int64_t)> on_progress{};
};

/// Simulates x_{k+1} = f(x_k, u_k(x_k)) + w_k from x_0 ~ belief, with the model, noise, belief and
/// policy of `motion`; its particles are not used. A path that is not finite counts as unsafe from
/// then on. Path i depends only on (seed, i), so the counts are the same for any number of threads.
/// Returns nothing if `should_stop` returned true before the end.
[[nodiscard]] std::optional<UnsafeCounts> simulate_unsafe_counts(
    const controller::PredictedMotion& motion, const controller::SafeSet& safe_set,
    const MonteCarloOptions& options);

/// The counts for the same paths, and the laws of their states.
struct SimulatedPaths {
  UnsafeCounts counts;
  PathLaws laws;
};

/// As `simulate_unsafe_counts`; keeps the first `kept` ≤ samples paths.
[[nodiscard]] std::optional<SimulatedPaths> simulate_paths(
    const controller::PredictedMotion& motion, const controller::SafeSet& safe_set,
    const MonteCarloOptions& options, std::int64_t kept);

}  // namespace qsmpc::harness
