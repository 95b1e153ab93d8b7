#include "harness/plant/mujoco_binding.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/Geometry>

#include "harness/errors.hpp"

namespace qsmpc {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;  // rad
// Layout of a free joint: position (3), quaternion (4); linear velocity in world axes (3), angular
// velocity in body axes (3).
constexpr int kQuaternion = 3;
constexpr int kAngularVelocity = 3;
constexpr int kFreeVelocities = 6;

struct ElementRange {
  int count;
  const int* name_addresses;
};

ElementRange elements(const mjModel& model, mjtObj type) {
  if (type == mjOBJ_JOINT) return {model.njnt, model.name_jntadr};
  return {model.nu, model.name_actuatoradr};
}

std::string names_of(const mjModel& model, mjtObj type) {
  const ElementRange range = elements(model, type);
  std::string names;
  for (int i = 0; i < range.count; ++i) {
    const std::string name = model.names + range.name_addresses[i];
    if (!name.empty()) names += (names.empty() ? "" : ", ") + name;
  }
  return names.empty() ? "none that has a name" : names;
}

/// Anchor of a joint in the axes of `body`, m.
Eigen::Vector3d anchor_in_body(const mjData& data, int joint, int body) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Eigen::Map<const RowMajor> rotation(data.xmat + std::ptrdiff_t{9} * body);
  const Eigen::Map<const Eigen::Vector3d> origin(data.xpos + std::ptrdiff_t{3} * body);
  const Eigen::Map<const Eigen::Vector3d> anchor(data.xanchor + std::ptrdiff_t{3} * joint);
  return rotation.transpose() * (anchor - origin);
}

double wheel_radius(const NamedModel& named, int joint) {
  const mjModel& model = named.model;
  const int body = model.jnt_bodyid[joint];
  for (int k = 0; k < model.body_geomnum[body]; ++k) {
    const int geom = model.body_geomadr[body] + k;
    const int type = model.geom_type[geom];
    const bool is_round = type == mjGEOM_SPHERE || type == mjGEOM_ELLIPSOID ||
                          type == mjGEOM_CYLINDER || type == mjGEOM_CAPSULE;
    const bool touches = model.geom_contype[geom] != 0 || model.geom_conaffinity[geom] != 0;
    if (is_round && touches) return model.geom_size[std::ptrdiff_t{3} * geom];
  }
  throw InputError({.file = named.file,
                    .key = "body " + std::string(model.names + model.name_bodyadr[body]),
                    .found = "no wheel",
                    .expected = "a sphere, ellipsoid, cylinder or capsule that collides"});
}

}  // namespace

int element_index(const NamedModel& named, mjtObj type, const std::string& name) {
  const int index = mj_name2id(&named.model, type, name.c_str());
  if (index >= 0) return index;
  const std::string kind = mju_type2Str(type);
  throw InputError({.file = named.file,
                    .key = kind + " " + name,
                    .found = "no such " + kind,
                    .expected = "it beside " + names_of(named.model, type)});
}

PoseBinding::PoseBinding(const NamedModel& named, const FreeJointPose& pose) : pose_(pose) {
  const int joint = element_index(named, mjOBJ_JOINT, pose.joint);
  if (named.model.jnt_type[joint] != mjJNT_FREE) {
    throw InputError({.file = named.file,
                      .key = "joint " + pose.joint,
                      .found = "another type of joint",
                      .expected = "a free joint"});
  }
  body_ = named.model.jnt_bodyid[joint];
  qpos_ = named.model.jnt_qposadr[joint];
  qvel_ = named.model.jnt_dofadr[joint];
}

Eigen::VectorXd PoseBinding::read(const mjData& data, double near_heading) const {
  const double* q = data.qpos + qpos_ + kQuaternion;
  const double yaw = std::atan2(2.0 * (q[0] * q[3] + q[1] * q[2]),
                                q[0] * q[0] + q[1] * q[1] - q[2] * q[2] - q[3] * q[3]);
  Eigen::VectorXd state(3);
  state[pose_.x] = data.qpos[qpos_];
  state[pose_.y] = data.qpos[qpos_ + 1];
  state[pose_.heading] = yaw + kTurn * std::round((near_heading - yaw) / kTurn);
  return state;
}

void PoseBinding::turn(mjData& data, double angle) const {
  Eigen::Map<Eigen::Vector4d> q(data.qpos + qpos_ + kQuaternion);
  const Eigen::Quaterniond about_z(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
  const Eigen::Quaterniond turned = about_z * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  q << turned.w(), turned.x(), turned.y(), turned.z();
  // The angular velocity is in body axes already.
  Eigen::Map<Eigen::Vector2d> velocity(data.qvel + qvel_);
  velocity = Eigen::Rotation2Dd(angle) * Eigen::Vector2d(velocity);
}

void PoseBinding::place(mjData& data, const Eigen::VectorXd& state) const {
  turn(data, state[pose_.heading] - read(data, 0.0)[pose_.heading]);
  data.qpos[qpos_] = state[pose_.x];
  data.qpos[qpos_ + 1] = state[pose_.y];
}

void PoseBinding::kick(mjData& data, const Eigen::VectorXd& disturbance) const {
  turn(data, disturbance[pose_.heading]);
  data.qpos[qpos_] += disturbance[pose_.x];
  data.qpos[qpos_ + 1] += disturbance[pose_.y];
}

double PoseBinding::speed(const mjData& data) const {
  return std::hypot(data.qvel[qvel_], data.qvel[qvel_ + 1]);
}

void PoseBinding::set_speed(mjData& data, double speed) const {
  const double heading = read(data, 0.0)[pose_.heading];
  Eigen::Map<Eigen::Matrix<double, kFreeVelocities, 1>> velocity(data.qvel + qvel_);
  velocity.setZero();
  velocity.head<kAngularVelocity>() << speed * std::cos(heading), speed * std::sin(heading), 0.0;
}

SteeringBinding::SteeringBinding(const NamedModel& named, const mjData& data, int body,
                                 const AckermannSteering& steering)
    : yaw_rate_(steering.yaw_rate), speed_(steering.speed) {
  Eigen::Vector3d axle = Eigen::Vector3d::Zero();
  for (const std::string& name : steering.fixed_axle) {
    axle += anchor_in_body(data, element_index(named, mjOBJ_JOINT, name), body);
  }
  axle /= static_cast<double>(steering.fixed_axle.size());
  for (const SteeredWheel& wheel : steering.wheels) {
    const int joint = element_index(named, mjOBJ_JOINT, wheel.joint);
    const Eigen::Vector3d offset = anchor_in_body(data, joint, body) - axle;
    if (!(offset.x() > 0.0)) {
      throw InputError({.file = named.file,
                        .key = "joint " + wheel.joint,
                        .found = std::to_string(offset.x()) + " m before the fixed axle",
                        .expected = "a steered wheel before it"});
    }
    wheels_.push_back({.actuator = element_index(named, mjOBJ_ACTUATOR, wheel.actuator),
                       .forward = offset.x(),
                       .left = offset.y()});
  }
}

// A point (forward, left) of a body that moves at v and yaws at ω about the middle of its axle has
// the velocity (v − ω left, ω forward); the wheel there must point along it.
void SteeringBinding::command(mjData& data, const Eigen::VectorXd& input) const {
  const double yaw_rate = input[yaw_rate_];
  for (const Wheel& wheel : wheels_) {
    data.ctrl[wheel.actuator] =
        std::atan2(yaw_rate * wheel.forward, speed_ - yaw_rate * wheel.left);
  }
}

SpeedHoldBinding::SpeedHoldBinding(const NamedModel& named, const SpeedHold& hold)
    : speed_(hold.speed), actuator_(element_index(named, mjOBJ_ACTUATOR, hold.actuator)) {
  for (const std::string& name : hold.wheels) {
    const int joint = element_index(named, mjOBJ_JOINT, name);
    wheels_.push_back(
        {.qvel = named.model.jnt_dofadr[joint], .radius = wheel_radius(named, joint)});
  }
  command_ = speed_ / wheels_.front().radius;
}

void SpeedHoldBinding::command(mjData& data) const { data.ctrl[actuator_] = command_; }

void SpeedHoldBinding::spin_up(mjData& data) const {
  for (const Wheel& wheel : wheels_) data.qvel[wheel.qvel] = speed_ / wheel.radius;
}

}  // namespace qsmpc
