// The record of one episode: a value that grows as the episode runs, and its only output. Videos,
// reports and summaries are made from it alone.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "controller/measure/measures.hpp"
#include "controller/planning/cost/cost_parts.hpp"
#include "harness/plant/plant.hpp"
#include "harness/scenario/scenario.hpp"
#include "models/constants.hpp"
#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// The weighted points of one stage of the horizon.
using StageParticles = controller::DiscreteMeasure;

/// Wall-clock times of one control step, in milliseconds; never part of the state.
struct StepTiming {
  double quantise = 0.0;
  double propagate =
      0.0;  ///< predictions outside the solver: linearisation, assignments, particles
  double optimise = 0.0;
  double certify = 0.0;
  double total = 0.0;     ///< quantise + propagate + optimise + certify
  double simulate = 0.0;  ///< the plant
};

/// The record of one control period, which begins at `time`.
struct StepRecord {
  double time = 0.0;            ///< s
  Eigen::VectorXd state;        ///< true state when the input is chosen, state_dim
  Eigen::VectorXd observation;  ///< what the planner sees of it, state_dim
  Eigen::VectorXd input;        ///< applied input, input_dim
  Eigen::VectorXd disturbance;  ///< added at the end of the period, state_dim
  /// x_{k+1} − w_k − f(x_k, u_k), state_dim: the part of the state at the period's end that neither
  /// the model f nor the disturbance w explains. NaN where that state is not a result of the plant.
  Eigen::VectorXd residual;
  /// Least distance to the unsafe set over the simulator's steps within the period, before the
  /// disturbance; NaN without a simulator, and in traces of earlier versions.
  double clearance_between = kNotANumber;
  PlantContact contact;
  // The moving obstacles, in their order, when the input is chosen.
  Eigen::Matrix3Xd obstacles;       ///< offset x, y (m) from their positions in the scenario,
                                    ///< rotation (rad)
  Eigen::Matrix2Xd obstacles_seen;  ///< the offsets as the planner sees them, m
  Eigen::VectorXd belief_mean;      ///< the belief that the plan was made for, state_dim
  Eigen::MatrixXd belief_covariance;
  // The plan; empty if the controller makes none.
  Eigen::MatrixXd plan_inputs;              ///< input_dim x horizon
  Eigen::MatrixXd plan_states;              ///< nominal states, state_dim x (horizon + 1)
  std::vector<Eigen::MatrixXd> plan_gains;  ///< horizon of input_dim x state_dim; empty also in
                                            ///< traces of earlier versions
  controller::CostParts cost;               ///< NaN if the controller has none
  std::string solver_status;                ///< name of the solver's status; empty without a solver
  bool fallback = false;                    ///< the shifted previous plan was applied instead
  int iterations = 0;                       ///< cost-and-gradient evaluations
  /// The controller's own estimate of the probability that the state at the end of the period is
  /// unsafe; NaN if it has none, and in traces of earlier versions. Not a bound.
  double believed = kNotANumber;
  std::vector<StageParticles> particles;  ///< horizon + 1; empty if the controller has none
  /// Stages 0 … horizon, or 0 and 1 if nothing is planned.
  std::vector<controller::StageBudget> budgets;
  std::vector<controller::StageCertificate> certificates;  ///< the same stages, without stage 0
  StepTiming timing;
};

/// How a drive ended. The first unsafe control instant decides, even if the drive continued after
/// it (limit.stop_when_unsafe: false); a fault or an interrupt takes precedence.
enum class Outcome {
  kReached,     ///< it arrived and was safe at every control instant
  kCollision,   ///< it entered an obstacle
  kLeftBounds,  ///< it left the bounds while in no obstacle
  kTimeout,     ///< it was always safe but did not arrive
  kFault,       ///< the simulator gave up, or an external controller failed
  kInterrupted
};

/// "reached", "collision", "left_bounds", "timeout", "fault" or "interrupted".
[[nodiscard]] const char* outcome_name(Outcome outcome);
/// All outcome names in this order; and the same as one text, separated by commas.
[[nodiscard]] const std::vector<std::string>& outcome_names();
[[nodiscard]] std::string outcome_list();
/// The inverse of `outcome_name`; throws std::invalid_argument.
[[nodiscard]] Outcome outcome_from_name(const std::string& name);

/// What caused the fault that ended a drive.
enum class FaultOf { kPlant, kController };

/// "plant" or "controller".
[[nodiscard]] const char* fault_of_name(FaultOf fault_of);

/// A trace is self-contained: its numbers can be interpreted without a model.
struct Trace {
  Scenario scenario;
  models::SystemDescription system;  ///< of the scenario's model
  std::string scenario_text;         ///< the resolved scenario as YAML
  std::uint64_t seed = 0;
  std::string version;
  /// plant_digest of the vehicle at the time of the drive; empty for an analytic plant and for
  /// traces of earlier versions.
  std::string vehicle_digest{};
  std::vector<StepRecord> steps;
  Eigen::VectorXd final_state;  ///< true state after the last period, state_dim; empty if unknown
  Eigen::Matrix3Xd final_obstacles{};  ///< as in a step, at the time of final_state
  std::vector<MotionSample> motion;    ///< for the whole episode, oldest first
  Outcome outcome = Outcome::kTimeout;
  std::string fault;  ///< if the outcome is kFault: what happened, e.g. the simulator's message
  FaultOf fault_of = FaultOf::kPlant;  ///< what caused that fault
  /// What an external controller wrote to its standard error during this drive, truncated if long.
  /// Not in the trace's file.
  std::string controller_log{};
};

/// The true states at the control instants, in their units: state_dim x (steps + 1), or state_dim x
/// steps if the state after the last step is not known.
[[nodiscard]] Eigen::MatrixXd true_states(const Trace& trace);

/// The unit of distances to the unsafe set: that of the states restricted by the safe set, or
/// "state units" if their units differ.
[[nodiscard]] std::string clearance_unit_of(const controller::SafeSet& safe_set,
                                            const models::SystemDescription& system);

/// How many periods the plant completed, so that the state at their end is a result of the plant.
[[nodiscard]] Eigen::Index completed_periods(const Trace& trace);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
