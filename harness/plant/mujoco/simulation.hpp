// A MuJoCo vehicle with its low-level loops, stepped: what the plant is made of. Private to the
// MuJoCo plant.
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
#include "harness/plant/mujoco/loaded_vehicle.hpp"
#include "harness/plant/mujoco/mujoco_plant.hpp"
#include "harness/plant/mujoco/solid_map.hpp"
#include "harness/plant/mujoco/state_binding.hpp"

namespace qsmpc::harness {

struct MujocoDataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

/// Where a vehicle was at each time step of a control period: its position states, and their rates.
struct PeriodPath {
  std::vector<Eigen::VectorXd> positions;
  std::vector<Eigen::VectorXd> rates;
};

/// Forces along the position states during one control period: springs and dampers that pull the
/// vehicle away from the path that it takes by itself. The free end of the springs moves by the
/// cubic that begins at rest and ends at `displacement` with the rate `rate`, both in the axes of
/// the vehicle at the period's beginning. Without a path, none.
struct PeriodPull {
  const PeriodPath* path = nullptr;  // outlives the period
  Eigen::VectorXd masses;            // apparent, of each position
  Eigen::VectorXd displacement;
  Eigen::VectorXd rate;
};

/// Everything that the next step depends on, the solver's warm start included.
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

  /// Places the settled vehicle at `state` and starts the time anew.
  void reset(const Eigen::VectorXd& state);
  /// The input of the next control period.
  void start_period(const Eigen::VectorXd& input);
  void set_pull(PeriodPull pull);
  /// Takes a period, noting its path.
  [[nodiscard]] PeriodPath take_period();
  void step();
  /// Adds `change` to the state. The heading is counted on.
  void add(const Eigen::VectorXd& change);

  /// The state after the last step.
  [[nodiscard]] const Eigen::VectorXd& state() const { return state_; }
  [[nodiscard]] double time() const { return static_cast<double>(steps_) * model_->opt.timestep; }
  [[nodiscard]] std::vector<double> qpos() const;
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] int period_steps() const { return period_steps_; }
  [[nodiscard]] double time_step() const { return model_->opt.timestep; }

  /// Whether the vehicle can touch what is solid; at first it cannot.
  void set_solid_standing(bool standing);
  /// Puts solid obstacles that move where they are, see SolidMap::place.
  void place_obstacles(const Eigen::Matrix3Xd& poses);
  /// How it touches what is solid now, see SolidMap; not a number where nothing is solid.
  [[nodiscard]] double contact_force() const;

  [[nodiscard]] SimulationSnapshot snapshot() const;
  void restore(const SimulationSnapshot& snapshot);

  /// The position states and their rates, in the axes of the vehicle where `heading` is that of
  /// the axes. Brings the data up to date.
  [[nodiscard]] Eigen::VectorXd placement(double heading);
  /// ∂rates/∂velocity states, for the smallest change of the generalised velocities.
  [[nodiscard]] Eigen::MatrixXd rates_by_velocities();
  /// What the vehicle opposes a force along each position state with: mass or inertia.
  [[nodiscard]] Eigen::VectorXd apparent_masses();
  [[nodiscard]] const StateBinding& binding() const { return states_; }
  /// The heading of the state, 0 where it has none.
  [[nodiscard]] double heading() const;
  /// See Plant::tilt. Balls may roll.
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
  enum class Feedback { kOff, kTest, kOn } feedback_mode_ = Feedback::kOn;
  Eigen::VectorXd test_controls_;  // of kTest
  struct RollingWheel {
    int dof;
    double radius;
  };
  std::vector<RollingWheel> rolling_;
  std::vector<int> tipping_;  // free joints of bodies that can tip over
  std::optional<SolidMap> solid_;
  Eigen::Matrix3Xd obstacles_;  // that move; empty until they are placed
  int period_steps_;
  long delay_steps_;

  SimulationSnapshot settled_;
  Eigen::VectorXd state_;
  long steps_ = 0;                      // since reset
  std::deque<Eigen::VectorXd> inputs_;  // of the last periods, oldest first
  long first_period_ = 0;               // that inputs_ begins with
  long active_period_ = -2;             // whose input acts; -1 before the first
  Eigen::VectorXd active_input_;
  Eigen::VectorXd targets_;
  PeriodPull pull_;
  long pull_start_ = 0;        // step at which its period begins
  Eigen::MatrixXd pull_axes_;  // of the vehicle then
};

}  // namespace qsmpc::harness
