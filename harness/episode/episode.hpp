// One closed loop: decide, certify, act on the plant, observe.
//
// The belief of x_{k+1}, on which the controller of period k + 1 may plan, is the estimator's
// prediction from the observations up to period k, as on a machine that needs the period to
// compute. When x_{k+1} is then observed, the controller's input may depend on it, as in the first
// stage of a policy. The plant's disturbance has a separate random stream; the controller sees
// nothing of the plant but the states at the ends of the periods.
//
// With measurement noise v_k ~ N(0, R), also from a separate stream, it sees y_k = x_k + v_k
// instead. The true state decides the outcome.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "harness/control/controller_object.hpp"
#include "harness/episode/drive.hpp"
#include "harness/episode/trace_header.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/trace/trace.hpp"
#include "models/random/noise_seeds.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

class TraceWriter;

struct EpisodeOptions {
  std::uint64_t seed = 0;
  /// Seed of the plant's disturbances if it differs from `seed`; the initial state and the
  /// measurement noise always use `seed`.
  std::optional<std::uint64_t> plant_seed{};
  /// Disturbances and measurement noise use these seeds from these periods on; ascending. Without a
  /// value, the scenario's (`disturbance.seeds`) apply.
  std::optional<std::vector<models::NoiseSeed>> noise{};
  /// Whether decisions are certified. A trace without certificates cannot be written.
  bool certify = true;
  /// Called after each step with the trace so far; may be empty.
  std::function<void(const Trace&)> on_step{};
  /// Called before each step; returning true ends the episode as interrupted.
  std::function<bool()> should_stop{};
  /// Receives every step as soon as it is complete, and the end of the episode; may be null.
  TraceWriter* writer = nullptr;
};

/// Drives episodes of one scenario, one after the other, with the same results as a new driver for
/// each. Tables and memory are reused, and plans are rehearsed once, at construction, so that the
/// first period of an episode takes no longer than the others.
class EpisodeDriver {
 public:
  /// `scenario` must outlive the driver. Throws std::invalid_argument on inconsistent settings of
  /// the controller.
  explicit EpisodeDriver(const Scenario& scenario);
  /// The same with `object` as the controller, whatever the scenario names.
  EpisodeDriver(const Scenario& scenario, ControllerObject object);
  EpisodeDriver(EpisodeDriver&&) noexcept;
  EpisodeDriver& operator=(EpisodeDriver&&) noexcept;
  ~EpisodeDriver();

  /// Runs one episode. A plant that fails, or a controller outside the program that fails, ends it
  /// with the outcome `fault`; numerical problems of the planner appear in the steps' solver
  /// status. Throws InputError on a problem with the plant's file, and IoError from the writer.
  [[nodiscard]] Trace run(const EpisodeOptions& options);

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
};

/// Runs one episode with a new driver. Throws as EpisodeDriver and its `run`.
[[nodiscard]] Trace run_episode(const Scenario& scenario, const EpisodeOptions& options);
[[nodiscard]] Trace run_episode(const Scenario& scenario, const EpisodeOptions& options,
                                ControllerObject object);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
