// The record of one episode: one growing value, and the only thing that leaves an episode.
// Videos, reports and summaries are made from it alone.
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

/// Everything about one control period, which begins at `time`.
struct StepRecord {
  double time = 0.0;            ///< s
  Eigen::VectorXd state;        ///< true state when the input is chosen, state_dim
  Eigen::VectorXd observation;  ///< what the planner sees of it, state_dim
  Eigen::VectorXd input;        ///< input that is applied, input_dim
  Eigen::VectorXd disturbance;  ///< added at the end of the period, state_dim
  /// x_{k+1} − w_k − f(x_k, u_k): what of the state at the end neither the model f nor the
  /// disturbance w explains, state_dim; not a number where that state is no result of the plant.
  Eigen::VectorXd residual;
  /// Least distance to the unsafe set at the simulator's steps within the period, before the
  /// disturbance; not a number without a simulator, and in traces of earlier versions.
  double clearance_between = kNotANumber;
  PlantContact contact;
  // Of the obstacles that move, in their order, when the input is chosen.
  Eigen::Matrix3Xd obstacles;       ///< offset x, y (m) from where they are written, turn (rad)
  Eigen::Matrix2Xd obstacles_seen;  ///< what the planner sees of the offsets, m
  Eigen::VectorXd belief_mean;      ///< what the plan was made for, state_dim
  Eigen::MatrixXd belief_covariance;
  // Of the plan; empty where the controller makes none.
  Eigen::MatrixXd plan_inputs;              ///< input_dim x horizon
  Eigen::MatrixXd plan_states;              ///< nominal states, state_dim x (horizon + 1)
  std::vector<Eigen::MatrixXd> plan_gains;  ///< horizon of input_dim x state_dim; empty also in
                                            ///< traces of earlier versions
  controller::CostParts cost;               ///< not a number where the controller has none
  std::string solver_status;                ///< name of the solver's status; empty without a solver
  bool fallback = false;                    ///< the shifted previous plan was applied instead
  int iterations = 0;                       ///< cost-and-gradient evaluations
  /// The controller's own estimate of the probability that the state at the end of the period is
  /// unsafe; not a number where it has none, and in traces of earlier versions. No bound.
  double believed = kNotANumber;
  std::vector<StageParticles> particles;  ///< horizon + 1; empty where the controller has none
  /// Stages 0 … horizon, or 0 and 1 where nothing is planned.
  std::vector<controller::StageBudget> budgets;
  std::vector<controller::StageCertificate> certificates;  ///< the same without stage 0
  StepTiming timing;
};

/// What became of a drive. Its first unsafe control instant decides, also where the drive went on
/// after it (limit.stop_when_unsafe: false); a fault or an interrupt is told before that.
enum class Outcome {
  kReached,     ///< it arrived, and was safe at every control instant
  kCollision,   ///< it entered an obstacle
  kLeftBounds,  ///< it left the bounds, in no obstacle at that instant
  kTimeout,     ///< it was safe all the time, and did not arrive
  kFault,       ///< the simulator gave up, or a controller outside of the program failed
  kInterrupted
};

/// "reached", "collision", "left_bounds", "timeout", "fault" or "interrupted".
[[nodiscard]] const char* outcome_name(Outcome outcome);
/// All of them in this order, and the same as one text, separated by commas.
[[nodiscard]] const std::vector<std::string>& outcome_names();
[[nodiscard]] std::string outcome_list();
/// The inverse of `outcome_name`; throws std::invalid_argument.
[[nodiscard]] Outcome outcome_from_name(const std::string& name);

/// Who broke a drive that ended as a fault.
enum class FaultOf { kPlant, kController };

/// "plant" or "controller".
[[nodiscard]] const char* fault_of_name(FaultOf fault_of);

/// A trace is whole: whoever reads it needs no model to say what its numbers are.
struct Trace {
  Scenario scenario;
  models::SystemDescription system;  ///< of the scenario's model
  std::string scenario_text;         ///< the resolved scenario as YAML
  std::uint64_t seed = 0;
  std::string version;
  /// plant_digest of the vehicle when it was driven; empty of an analytic plant, and of traces of
  /// earlier versions.
  std::string vehicle_digest{};
  std::vector<StepRecord> steps;
  Eigen::VectorXd final_state;  ///< true state after the last period, state_dim; empty if not known
  Eigen::Matrix3Xd final_obstacles{};  ///< as a step's, at the same time
  std::vector<MotionSample> motion;    ///< of the whole episode, oldest first
  Outcome outcome = Outcome::kTimeout;
  std::string fault;  ///< what happened where the outcome is kFault, e.g. the simulator's words
  FaultOf fault_of = FaultOf::kPlant;  ///< who broke it there
  /// What a controller outside of the program wrote to its standard error in this drive, cut where
  /// it is long. Not in the trace's file.
  std::string controller_log{};
};

/// The true states at the control instants, in their units: state_dim x (steps + 1), or as many
/// columns as there are steps where the state after the last one is not known.
[[nodiscard]] Eigen::MatrixXd true_states(const Trace& trace);

/// The unit of distances to the unsafe set: that of the states which the safe set restricts, or
/// "state units" where they differ.
[[nodiscard]] std::string clearance_unit_of(const controller::SafeSet& safe_set,
                                            const models::SystemDescription& system);

/// How many periods the plant came through: those of which the state at the end is a result.
[[nodiscard]] Eigen::Index completed_periods(const Trace& trace);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
