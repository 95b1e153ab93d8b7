// One closed loop in receding horizon (Algorithm 5): plan, certify, act on the plant, observe.
//
// The plan of a period is made one period ahead, as on a machine that needs the period to compute:
// having seen x_k and applied u_k, the belief of x_{k+1} is the model's prediction
// N(f(x_k, u_k), Σ_w). When x_{k+1} is then observed, the first stage of the policy is evaluated at
// it. The plant's disturbance comes from a random stream of its own; the planner sees nothing of
// the plant but the states at the ends of the periods.
//
// With measurement noise v_k ~ N(0, R), from another stream of its own, the planner sees
// y_k = x_k + v_k instead: the policy is evaluated at y_k, and the belief of x_{k+1} is
// N(f(y_k, u_k), A R Aᵀ + Σ_w) with A = ∂f/∂x at (y_k, u_k). The true state decides the outcome.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "harness/scenario/scenario.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::harness {

class TraceWriter;

struct EpisodeOptions {
  std::uint64_t seed = 0;
  /// Seed of the plant's disturbances where it is not `seed`; the initial state and the
  /// measurement noise stay those of `seed`.
  std::optional<std::uint64_t> plant_seed{};
  /// Called after each step with the trace so far; not with none.
  std::function<void(const Trace&)> on_step{};
  /// Asked before each step; true ends the episode as interrupted.
  std::function<bool()> should_stop{};
  /// Receives every step as soon as it is done, and the end; may be null.
  TraceWriter* writer = nullptr;
};

/// The header of the trace of `scenario`: scenario, its text, seed, version.
[[nodiscard]] Trace trace_header(const Scenario& scenario, std::uint64_t seed);

/// Drives episodes of one scenario, one after the other. Each is what a driver of its own would
/// make of it; tables and memory, and the two plans made beforehand so that the first period of an
/// episode takes no longer than the others, are those of the first.
class EpisodeDriver {
 public:
  /// `scenario` must outlive the driver. Throws std::invalid_argument on settings of the planner
  /// that make no sense.
  explicit EpisodeDriver(const Scenario& scenario);
  EpisodeDriver(EpisodeDriver&&) noexcept;
  EpisodeDriver& operator=(EpisodeDriver&&) noexcept;
  ~EpisodeDriver();

  /// Runs one episode. A plant that breaks ends it with the outcome `fault`; numerical trouble of
  /// the planner is in the steps' solver status. Throws InputError for what is wrong with the
  /// plant's file and IoError from the writer.
  [[nodiscard]] Trace run(const EpisodeOptions& options);

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
};

/// Runs one episode, with a driver of its own. Throws as EpisodeDriver and its `run`.
[[nodiscard]] Trace run_episode(const Scenario& scenario, const EpisodeOptions& options);

}  // namespace qsmpc::harness
