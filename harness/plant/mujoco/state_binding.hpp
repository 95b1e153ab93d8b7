// Reading and writing a system's states in a MuJoCo model. Private to the MuJoCo plant.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "harness/mujoco/named_model.hpp"
#include "harness/scenario/plant_mapping.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Writing uses Jacobians: positions are moved, and velocities changed, by the smallest change of
/// the generalised coordinates that has the desired effect. For a free joint, or for joints in the
/// plane, that is the vehicle's own motion in the plane; height, roll, pitch and wheels are
/// unchanged. States that are read from sensors cannot be written.
class StateBinding {
 public:
  /// data: after mj_forward at the model's reference pose. Throws InputError on a name that the
  /// model does not have, a joint that is neither slide nor hinge, a sensor with too few numbers,
  /// and states that determine one another.
  StateBinding(const NamedModel& named, mjData& data, const PlantMapping& mapping,
               const models::SystemDescription& system);

  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(states_.size()); }

  /// The state (size()), with angles of bodies unwrapped to be nearest to those in `near`. data:
  /// with positions and velocities up to date, except that joints and bodies on a free joint are
  /// read from the generalised coordinates.
  [[nodiscard]] Eigen::VectorXd read(const mjData& data, const Eigen::VectorXd& near) const;

  /// Adds `change` to the state, and turns the velocity of the body that carries the heading with
  /// it. data: up to date before and after. Throws MujocoError where that is impossible.
  void add(mjData& data, const Eigen::VectorXd& change) const;

  /// Whether `state` can be written.
  [[nodiscard]] bool is_writable(Eigen::Index state) const;
  /// Whether any state is a velocity.
  [[nodiscard]] bool has_velocity() const;
  /// The body whose heading, or else whose first position, is a state; 0 without one.
  [[nodiscard]] int carrier() const { return carrier_; }

  /// Rows ∂position/∂(generalised coordinates) of the states that are positions, in their order.
  /// data: with positions up to date.
  [[nodiscard]] Eigen::MatrixXd position_jacobian(mjData& data) const;
  /// The same for the velocity states: ∂velocity/∂(generalised velocities).
  [[nodiscard]] Eigen::MatrixXd velocity_jacobian(mjData& data) const;
  [[nodiscard]] const std::vector<Eigen::Index>& positions() const { return positions_; }
  [[nodiscard]] const std::vector<Eigen::Index>& velocities() const { return velocities_; }

 private:
  /// The resolved kind of a state.
  enum class Kind {
    kJointPosition,
    kJointVelocity,
    kX,
    kY,
    kZ,
    kRoll,
    kPitch,
    kYaw,
    kVelocityX,
    kVelocityY,
    kForwardSpeed,
    kLateralSpeed,
    kYawRate,
    kSensor
  };
  struct State {
    Kind kind;
    int body;      ///< of a body's quantity, or of a joint
    int address;   ///< of a joint in qpos, or of a sensor's data
    int dof;       ///< of the joint, or the first of the body's free joint, in qvel
    int free_pos;  ///< of the body's free joint in qpos, or -1
    double gain;
    double offset;
  };

  [[nodiscard]] State resolve(const NamedModel& named, const PlantQuantity& quantity) const;
  [[nodiscard]] double quantity(const mjData& data, const State& state) const;
  [[nodiscard]] Eigen::RowVectorXd gradient(mjData& data, const State& state) const;
  void move(mjData& data, const Eigen::VectorXd& change) const;
  void accelerate(mjData& data, const Eigen::VectorXd& change, double turn,
                  const Eigen::Vector3d& velocity) const;
  void check_rank(const NamedModel& named, mjData& data,
                  const models::SystemDescription& system) const;

  const mjModel& model_;
  std::vector<State> states_;
  std::vector<Eigen::Index> positions_;   // states that can be written as positions
  std::vector<Eigen::Index> velocities_;  // states that can be written as velocities
  int carrier_ = 0;
  Eigen::Index heading_ = -1;  // the state that is the carrier's heading
};

}  // namespace qsmpc::harness
