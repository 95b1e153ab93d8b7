// The stepped simulation of a MuJoCo vehicle with its low-level loops, on which the plant is built.
// Private to the MuJoCo plant.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

#include "harness/mujoco/mujoco_model.hpp"
#include "harness/plant/mujoco/applied_forces.hpp"
#include "harness/plant/mujoco/control_binding.hpp"
#include "harness/plant/mujoco/feedback_binding.hpp"
#include "harness/plant/mujoco/gait_binding.hpp"
#include "harness/plant/mujoco/loaded_vehicle.hpp"
#include "harness/plant/mujoco/mujoco_plant.hpp"
#include "harness/plant/mujoco/solid_map.hpp"
#include "harness/plant/mujoco/state_binding.hpp"

namespace qsmpc::harness {

struct MujocoDataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

/// The path of a vehicle over a control period: its position states and their rates at each step.
struct PeriodPath {
  std::vector<Eigen::VectorXd> positions;
  std::vector<Eigen::VectorXd> rates;
};

/// Forces along the position states during one control period: springs and dampers that pull the
/// vehicle away from its undisturbed path. The free end of the springs follows the cubic that
/// starts at rest and ends at `displacement` with the rate `rate`, both in the vehicle's axes at
/// the start of the period. No forces if `path` is null.
struct PeriodPull {
  const PeriodPath* path = nullptr;  // must outlive the period
  Eigen::VectorXd masses;            // apparent, of each position
  Eigen::VectorXd displacement;
  Eigen::VectorXd rate;
};

/// Everything that the next step depends on, including the solver's warm start.
struct SimulationSnapshot {
  std::vector<double> qpos;
  std::vector<double> qvel;
  std::vector<double> act;
  std::vector<double> qacc_warmstart;
  std::vector<double> ctrl;
  std::vector<Eigen::VectorXd> tyre_loads;  // N
  std::vector<double> feedback_memories;
  Eigen::VectorXd state;
  long steps = 0;
};

/// Throws MujocoError on any error or warning of MuJoCo, and on a state that is not finite or
/// huge; InputError where the constructor refuses a model, see make_mujoco_plant.
class Simulation {
 public:
  explicit Simulation(const MujocoPlantSetup& setup);

  /// Places the settled vehicle at `state` and restarts the time.
  void reset(const Eigen::VectorXd& state);
  /// Sets the input of the next control period.
  void start_period(const Eigen::VectorXd& input);
  void set_pull(PeriodPull pull);
  /// Simulates a period and records its path.
  [[nodiscard]] PeriodPath take_period();
  void step();
  /// Adds `change` to the state. The heading is not wrapped.
  void add(const Eigen::VectorXd& change);

  /// The state after the last step.
  [[nodiscard]] const Eigen::VectorXd& state() const { return state_; }
  [[nodiscard]] double time() const { return static_cast<double>(steps_) * model_->opt.timestep; }
  [[nodiscard]] std::vector<double> qpos() const;
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] int period_steps() const { return period_steps_; }
  [[nodiscard]] double time_step() const { return model_->opt.timestep; }

  /// Whether the vehicle collides with solid walls and obstacles; initially it does not.
  void set_solid_standing(bool standing);
  /// Moves the moving solid obstacles to `poses`, see SolidMap::place.
  void place_obstacles(const Eigen::Matrix3Xd& poses);
  /// The present contact force with solids, N, see SolidMap; not a number where nothing is solid.
  [[nodiscard]] double contact_force() const;

  [[nodiscard]] SimulationSnapshot snapshot() const;
  void restore(const SimulationSnapshot& snapshot);

  /// The position states and their rates, in the vehicle's axes for `heading`. Brings the data up
  /// to date.
  [[nodiscard]] Eigen::VectorXd placement(double heading);
  /// ∂rates/∂velocity states, for the smallest change of the generalised velocities.
  [[nodiscard]] Eigen::MatrixXd rates_by_velocities();
  /// The apparent mass or inertia along each position state.
  [[nodiscard]] Eigen::VectorXd apparent_masses();
  [[nodiscard]] const StateBinding& binding() const { return states_; }
  /// The state's heading; 0 without one.
  [[nodiscard]] double heading() const;
  /// See Plant::tilt. Balls are excluded.
  [[nodiscard]] double tilt() const;

 private:
  Simulation(const MujocoPlantSetup& setup, LoadedVehicle loaded);
  void find_tipping_joints();
  void settle(double duration);
  void run_idle(double duration);
  void settle_with_feedback(double duration);
  [[nodiscard]] double measured_response(const FeedbackBinding& feedback);
  void control();
  void choose_input();
  void apply_forces();
  void apply_pull();
  void keep_level(Eigen::Ref<Eigen::VectorXd> applied);
  void check() const;
  void set_forward_speed(int body, double speed);
  [[nodiscard]] double forward_speed(int body) const;
  [[nodiscard]] Eigen::MatrixXd frame(double heading) const;

  std::string file_;
  models::SystemDescription system_;
  MujocoModelPtr model_;
  std::unique_ptr<mjData, MujocoDataDeleter> data_;
  StateBinding states_;
  ControlBinding controls_;
  std::vector<AxleForceBinding> axles_;
  std::vector<TyreForceBinding> tyres_;
  std::vector<FeedbackBinding> feedbacks_;
  std::vector<GaitBinding> gaits_;
  enum class Feedback { kOff, kTest, kOn } feedback_mode_ = Feedback::kOn;
  Eigen::VectorXd test_controls_;  // of kTest
  struct RollingWheel {
    int dof;
    double radius;
  };
  std::vector<RollingWheel> rolling_;
  std::vector<int> tipping_;  // free joints of bodies that can tip over
  std::optional<SolidMap> solid_;
  Eigen::Matrix3Xd obstacles_;  // of moving obstacles; empty until placed
  int period_steps_;
  long delay_steps_;

  SimulationSnapshot settled_;
  Eigen::VectorXd state_;
  long steps_ = 0;                      // since reset
  std::deque<Eigen::VectorXd> inputs_;  // of the latest periods, oldest first
  long first_period_ = 0;               // of the first entry of inputs_
  long active_period_ = -2;             // whose input is in effect; -1: none, before the first
  Eigen::VectorXd active_input_;
  Eigen::VectorXd targets_;
  PeriodPull pull_;
  long pull_start_ = 0;        // first step of its period
  Eigen::MatrixXd pull_axes_;  // the vehicle's axes at that step
};

}  // namespace qsmpc::harness
