// How often the model is unsafe under a policy, by simulating it: a check of the certificates that
// shares nothing with them but the model.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "controller/prediction/prediction.hpp"
#include "controller/regions/safe_set.hpp"
#include "harness/prediction/path_collector.hpp"

namespace qsmpc::harness {

/// How many of the simulated paths were unsafe.
struct UnsafeCounts {
  std::int64_t samples = 0;
  std::vector<std::int64_t> stages;  ///< at stage 1 … horizon
  std::int64_t any_stage = 0;        ///< at one of them at least
};

struct MonteCarloOptions {
  std::uint64_t seed = 0;
  std::int64_t samples = 0;
  int threads = 0;  ///< 0: as many as the processor runs at once
  /// Asked between batches, by several threads; true gives the work up.
  std::function<bool()> should_stop{};
  /// Told how many paths of how many are done, by the calling thread.
  std::function<void(std::int64_t, std::int64_t)> on_progress{};
};

/// Simulates x_{k+1} = f(x_k, u_k(x_k)) + w_k from x_0 ~ belief, with the model, the noise, the
/// belief and the policy of `motion`; of its particles nothing is used. A path that is not finite
/// counts as unsafe from then on. Path i depends on (seed, i) alone, so the counts are the same for
/// any number of threads. Nothing if `should_stop` said so before the end.
[[nodiscard]] std::optional<UnsafeCounts> simulate_unsafe_counts(
    const controller::PredictedMotion& motion, const controller::SafeSet& safe_set,
    const MonteCarloOptions& options);

/// The same paths, and what they say of the laws of their states.
struct SimulatedPaths {
  UnsafeCounts counts;
  PathLaws laws;
};

/// As `simulate_unsafe_counts`; keeps the first `kept` ≤ samples paths.
[[nodiscard]] std::optional<SimulatedPaths> simulate_paths(
    const controller::PredictedMotion& motion, const controller::SafeSet& safe_set,
    const MonteCarloOptions& options, std::int64_t kept);

}  // namespace qsmpc::harness
