// A MujocoMapping resolved in a loaded model: addresses instead of names, geometry as the model has
// it. Private to the MuJoCo plant; include it from its sources only, since it shows MuJoCo's types.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

#include "harness/plant/mujoco_mapping.hpp"

namespace qsmpc {

/// A model and what errors about it name.
struct NamedModel {
  const mjModel& model;
  std::string file;
};

/// A free joint as planar pose.
class PoseBinding {
 public:
  /// Throws InputError if the joint is missing or not free.
  PoseBinding(const NamedModel& named, const FreeJointPose& pose);

  /// State (3) with the heading nearest to `near_heading` (rad), so that turns are counted.
  [[nodiscard]] Eigen::VectorXd read(const mjData& data, double near_heading) const;

  /// Moves the joint to `state`'s x, y and heading. Height, roll and pitch stay, and so do
  /// velocities as seen from the vehicle.
  void place(mjData& data, const Eigen::VectorXd& state) const;

  /// Adds `disturbance` to x, y and heading; everything else stays as seen from the vehicle.
  void kick(mjData& data, const Eigen::VectorXd& disturbance) const;

  /// Index of the heading in the state.
  [[nodiscard]] int heading() const { return pose_.heading; }
  /// The body that the joint moves.
  [[nodiscard]] int body() const { return body_; }
  /// Speed in the plane, m/s.
  [[nodiscard]] double speed(const mjData& data) const;
  /// Sets the velocity along the vehicle's x axis (m/s), which lies level, and no other.
  void set_speed(mjData& data, double speed) const;

 private:
  void turn(mjData& data, double angle) const;

  FreeJointPose pose_;
  int body_;
  int qpos_;
  int qvel_;
};

class SteeringBinding {
 public:
  /// data: after mj_forward at the model's reference pose. body: the root, whose x axis points
  /// forward. Throws InputError on a missing name or a wheelbase that is not positive.
  SteeringBinding(const NamedModel& named, const mjData& data, int body,
                  const AckermannSteering& steering);

  void command(mjData& data, const Eigen::VectorXd& input) const;

 private:
  struct Wheel {
    int actuator;
    double forward;  ///< m from the fixed axle
    double left;     ///< m from the middle of the fixed axle
  };
  int yaw_rate_;
  double speed_;
  std::vector<Wheel> wheels_;
};

class SpeedHoldBinding {
 public:
  /// Throws InputError on a missing name or wheels without a round geom that touches the ground.
  SpeedHoldBinding(const NamedModel& named, const SpeedHold& hold);

  void command(mjData& data) const;
  /// Spins the wheels as they would roll at speed.
  void spin_up(mjData& data) const;
  /// Corrects the command by the steady speed (m/s, > 0) to which it led: a loaded wheel rolls on
  /// slightly less than its radius and the servo droops under rolling resistance.
  void calibrate(double steady_speed) { command_ *= speed_ / steady_speed; }

  [[nodiscard]] double speed() const { return speed_; }

 private:
  struct Wheel {
    int qvel;
    double radius;  ///< m
  };
  double speed_;
  int actuator_;
  double command_;  ///< rad/s
  std::vector<Wheel> wheels_;
};

using LoopBinding = std::variant<SteeringBinding, SpeedHoldBinding>;

/// Index of the element of `type` called `name`. Throws InputError that lists those which exist.
[[nodiscard]] int element_index(const NamedModel& named, mjtObj type, const std::string& name);

}  // namespace qsmpc
