// One closed loop: decide, certify, act on the plant, observe.
//
// The belief of x_{k+1}, for which the controller of period k + 1 may plan, is the estimator's
// prediction from what was seen in period k, as on a machine that needs the period to compute. When
// x_{k+1} is then observed, the controller's input may depend on it, as the first stage of a policy
// does. The plant's disturbance comes from a random stream of its own; the controller sees nothing
// of the plant but the states at the ends of the periods.
//
// With measurement noise v_k ~ N(0, R), from another stream of its own, it sees y_k = x_k + v_k
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
  /// Seed of the plant's disturbances where it is not `seed`; the initial state and the
  /// measurement noise stay those of `seed`.
  std::optional<std::uint64_t> plant_seed{};
  /// From these periods on, disturbances and measurement noise are those of other seeds; ascending.
  /// Where it is nothing, those of the scenario (`disturbance.seeds`).
  std::optional<std::vector<models::NoiseSeed>> noise{};
  /// Whether decisions are certified. A trace without certificates cannot be written.
  bool certify = true;
  /// Called after each step with the trace so far; not with none.
  std::function<void(const Trace&)> on_step{};
  /// Asked before each step; true ends the episode as interrupted.
  std::function<bool()> should_stop{};
  /// Receives every step as soon as it is done, and the end; may be null.
  TraceWriter* writer = nullptr;
};

/// Drives episodes of one scenario, one after the other. Each is what a driver of its own would
/// make of it; tables and memory, and the two plans made beforehand so that the first period of an
/// episode takes no longer than the others, are those of the first.
class EpisodeDriver {
 public:
  /// `scenario` must outlive the driver. Throws std::invalid_argument on settings of the controller
  /// that make no sense.
  explicit EpisodeDriver(const Scenario& scenario);
  /// The same with `object` as its controller, whatever the scenario says.
  EpisodeDriver(const Scenario& scenario, ControllerObject object);
  EpisodeDriver(EpisodeDriver&&) noexcept;
  EpisodeDriver& operator=(EpisodeDriver&&) noexcept;
  ~EpisodeDriver();

  /// Runs one episode. A plant that breaks, or a controller outside of the program that
  /// fails, ends it with the outcome `fault`; numerical trouble of
  /// the planner is in the steps' solver status. Throws InputError for what is wrong with the
  /// plant's file and IoError from the writer.
  [[nodiscard]] Trace run(const EpisodeOptions& options);

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
};

/// Runs one episode, with a driver of its own. Throws as EpisodeDriver and its `run`.
[[nodiscard]] Trace run_episode(const Scenario& scenario, const EpisodeOptions& options);
[[nodiscard]] Trace run_episode(const Scenario& scenario, const EpisodeOptions& options,
                                ControllerObject object);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
