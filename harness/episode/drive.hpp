// A closed loop that its caller advances period by period: the caller decides; the drive certifies
// the decision, applies it to the plant, and observes.
//
//   Drive drive(scenario);
//   drive.begin({.seed = 1});
//   while (!drive.outcome()) drive.advance(controller->decide(drive.situation()));
//   write_trace("episode.h5", drive.trace());
//
// Observation, belief and randomness are explained in episode.hpp.
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
  /// Seed of the plant's disturbances if it differs from `seed`; the initial state and the
  /// measurement noise always use `seed`.
  std::optional<std::uint64_t> plant_seed{};
  /// Disturbances and measurement noise use these seeds from these periods on; ascending. Without a
  /// value, the scenario's (`disturbance.seeds`) apply.
  std::optional<std::vector<models::NoiseSeed>> noise{};
  /// Whether decisions are certified. A trace without certificates cannot be written.
  bool certify = true;
};

class Drive {
 public:
  /// Throws std::invalid_argument on inconsistent settings.
  explicit Drive(const Scenario& scenario);
  Drive(Drive&&) noexcept;
  Drive& operator=(Drive&&) noexcept;
  ~Drive();

  /// The planner's model of the scenario.
  [[nodiscard]] const models::Dynamics& model() const;

  /// The scenario with the drive's forecast of moving obstacles; the drive's controllers must be
  /// made from it.
  [[nodiscard]] const Scenario& scenario() const;

  /// Begins an episode and discards the one before. A vehicle that the simulator rejects gives the
  /// outcome `fault`. Throws InputError on any other problem with the plant's file, and
  /// Interrupted.
  void begin(const DriveOptions& options);

  /// Number of the period to be decided, from 0.
  [[nodiscard]] int period() const;

  /// The position of the true state along the scenario's path, m, or the number of waypoints
  /// passed; nothing without a path or waypoints.
  [[nodiscard]] std::optional<double> progress() const;

  /// The information available for choosing the next input; refers to this object and is valid
  /// until the next call of `advance` or `begin`. After the episode, it contains the observation of
  /// the last state.
  [[nodiscard]] controller::Situation situation() const;

  /// Sets what is known of the moving obstacles, in their order, until the drive next observes
  /// them: for situations that the caller constructs. Without it, the prior knowledge applies.
  /// Throws std::invalid_argument on another number of obstacles, on fewer stages than controllers
  /// look ahead, and as ObstacleForecast::set.
  void know_obstacles(const std::vector<controller::PlacesByStage>& obstacles);

  /// The true state now, state_dim; after the episode, the one in which it ended.
  [[nodiscard]] const Eigen::VectorXd& state() const;

  /// Clearance of the true state from the unsafe set, with obstacles at their true positions.
  [[nodiscard]] double clearance() const;

  /// Applies `decision` for one control period. Returns the record of the period, which is valid
  /// until the next call. Throws std::invalid_argument if the episode is over or the input is not
  /// finite or of the wrong size. Throws Interrupted: the period is then not part of the episode,
  /// which is over.
  const StepRecord& advance(const controller::Decision& decision);

  /// Index of the first motion sample in the trace that the last period added; for the first
  /// period, these include the initial sample.
  [[nodiscard]] std::size_t motion_begin() const;

  /// The outcome of the episode; nothing while it is running.
  [[nodiscard]] const std::optional<Outcome>& outcome() const;

  /// Ends the episode, e.g. as kInterrupted, or as a kFault of the controller with its message.
  void end(Outcome outcome, const std::string& fault = {}, FaultOf fault_of = FaultOf::kPlant);

  /// The episode so far. Its outcome is kTimeout while it is running.
  [[nodiscard]] const Trace& trace() const;
  /// The same, moved out of the drive, which must then begin anew.
  [[nodiscard]] Trace take();

  /// A typical belief of later periods of an episode, predicted from the initial mean and the
  /// middle of the input bounds.
  [[nodiscard]] controller::Gaussian later_belief() const;

  /// A situation in period `period` ≥ 0 with the mean of `belief` observed; refers to `belief`.
  [[nodiscard]] controller::Situation situation_of(const controller::Gaussian& belief,
                                                   int period) const;

  /// Certifies `decision` as `advance` does, unless `certify` is false, and records it, but does
  /// not apply it.
  [[nodiscard]] StepRecord record_of(const controller::Situation& situation,
                                     const controller::Decision& decision, bool certify = true);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace qsmpc::harness

#pragma GCC visibility pop
