// A closed loop that its caller moves on, period by period: the caller decides, the drive certifies
// the decision, applies it to the plant, and observes.
//
//   Drive drive(scenario);
//   drive.begin({.seed = 1});
//   while (!drive.outcome()) drive.advance(controller->decide(drive.situation()));
//   write_trace("episode.h5", drive.trace());
//
// What is observed, believed and random is explained in episode.hpp.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/control/controller.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/trace/trace.hpp"
#include "models/dynamics/dynamics.hpp"
#include "models/random/noise_seeds.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

struct DriveOptions {
  std::uint64_t seed = 0;
  /// Seed of the plant's disturbances where it is not `seed`; the initial state and the
  /// measurement noise stay those of `seed`.
  std::optional<std::uint64_t> plant_seed{};
  /// From these periods on, disturbances and measurement noise are those of other seeds; ascending.
  /// Where it is nothing, those of the scenario (`disturbance.seeds`).
  std::optional<std::vector<models::NoiseSeed>> noise{};
  /// Whether decisions are certified. A trace without certificates cannot be written.
  bool certify = true;
};

class Drive {
 public:
  /// Throws std::invalid_argument on settings that make no sense.
  explicit Drive(const Scenario& scenario);
  Drive(Drive&&) noexcept;
  Drive& operator=(Drive&&) noexcept;
  ~Drive();

  /// The planner's model of the scenario.
  [[nodiscard]] const models::Dynamics& model() const;

  /// The scenario with the drive's forecast of the obstacles that move, which controllers of the
  /// drive are to be made from.
  [[nodiscard]] const Scenario& scenario() const;

  /// Begins an episode; the one before is forgotten. A vehicle that the simulator refuses is the
  /// outcome `fault`. Throws InputError for what else is wrong with the plant's file, and
  /// Interrupted.
  void begin(const DriveOptions& options);

  /// Number of the period that is to be decided, from 0.
  [[nodiscard]] int period() const;

  /// Where the true state is along the scenario's path, m, or how many waypoints it has passed;
  /// nothing without either.
  [[nodiscard]] std::optional<double> progress() const;

  /// What is known when the next input is to be chosen; refers to this object, until the next call
  /// of `advance` or `begin`. After the episode, what is seen of its last state.
  [[nodiscard]] controller::Situation situation() const;

  /// Sets what is known of the obstacles that move, in their order, until the drive sees them next:
  /// for situations of the caller's. Without it, what is known before anything is seen. Throws
  /// std::invalid_argument on other numbers of them, on fewer stages than are looked ahead, and as
  /// ObstacleForecast::set.
  void know_obstacles(const std::vector<controller::PlacesByStage>& obstacles);

  /// The true state now, state_dim; after the episode, the one in which it ended.
  [[nodiscard]] const Eigen::VectorXd& state() const;

  /// Of the true state from what is unsafe, with the obstacles where they truly are.
  [[nodiscard]] double clearance() const;

  /// Applies `decision` for one control period. Returns the record of the period, which is valid
  /// until the next call. Throws std::invalid_argument where the episode is over or the input
  /// is not finite or of the wrong size, and Interrupted: the period is then not part of the
  /// episode, which is over.
  const StepRecord& advance(const controller::Decision& decision);

  /// Samples of the motion that the last period added to the trace, and before it the first sample.
  [[nodiscard]] std::size_t motion_begin() const;

  /// How the episode ended; nothing while it goes on.
  [[nodiscard]] const std::optional<Outcome>& outcome() const;

  /// Ends the episode, e.g. as kInterrupted or as a kFault of the controller with its words.
  void end(Outcome outcome, const std::string& fault = {}, FaultOf fault_of = FaultOf::kPlant);

  /// The episode so far. Its outcome is kTimeout while it goes on.
  [[nodiscard]] const Trace& trace() const;
  /// The same, taken from the drive, which has to begin anew.
  [[nodiscard]] Trace take();

  /// The belief that a later period of an episode begins with, from the mean of the first and the
  /// middle of the input bounds.
  [[nodiscard]] controller::Gaussian later_belief() const;

  /// A situation of period `period` ≥ 0 in which the mean of `belief` is seen; refers to `belief`.
  [[nodiscard]] controller::Situation situation_of(const controller::Gaussian& belief,
                                                   int period) const;

  /// Certifies `decision` as `advance` does, unless told not to, and records it, but does not apply
  /// it.
  [[nodiscard]] StepRecord record_of(const controller::Situation& situation,
                                     const controller::Decision& decision, bool certify = true);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace qsmpc::harness

#pragma GCC visibility pop
