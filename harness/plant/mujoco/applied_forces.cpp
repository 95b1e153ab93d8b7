#include "harness/plant/mujoco/applied_forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

#include "harness/plant/mujoco/control_binding.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kLeastUpright = 0.5;  // vertical component of a carrying contact's normal

/// Adds a force at a point, both in the world's axes, to what is applied to a body.
void push(mjData& data, int body, const Eigen::Vector3d& force, const Eigen::Vector3d& point) {
  const Eigen::Map<const Eigen::Vector3d> centre(data.xipos + std::ptrdiff_t{3} * body);
  Eigen::Map<Eigen::Matrix<double, 6, 1>> applied(data.xfrc_applied + std::ptrdiff_t{6} * body);
  applied.head<3>() += force;
  applied.tail<3>() += (point - centre).cross(force);
}

struct PlaneMotion {
  Eigen::Vector3d forward;  ///< level unit vector
  Eigen::Vector3d left;     ///< level unit vector
  double speed;             ///< m/s, along
  double lateral;           ///< m/s, across
  double yaw_rate;          ///< rad/s
};

PlaneMotion plane_motion(const mjModel& model, const mjData& data, int body,
                         const Eigen::Vector3d& along) {
  std::array<double, 6> motion{};
  mj_objectVelocity(&model, &data, mjOBJ_XBODY, body, motion.data(), 0);
  const Eigen::Vector3d level(along.x(), along.y(), 0.0);
  const double length = level.norm();
  const Eigen::Vector3d forward =
      length > 0.0 ? Eigen::Vector3d(level / length) : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(forward);
  const Eigen::Vector3d velocity(motion[3], motion[4], motion[5]);
  return {.forward = forward,
          .left = left,
          .speed = forward.dot(velocity),
          .lateral = left.dot(velocity),
          .yaw_rate = motion[2]};
}

/// Fiala's brush model: the share of the available friction as a function of normalised slip.
double brush(double slip) {
  constexpr double kFullSlide = 3.0;
  if (slip >= kFullSlide) return 1.0;
  return slip - slip * slip / 3.0 + slip * slip * slip / 27.0;
}

}  // namespace

AxleForceBinding::AxleForceBinding(const NamedModel& named, const AxleForces& forces,
                                   const models::SystemDescription& system)
    : model_(named.model),
      body_(element_index(named, mjOBJ_BODY, forces.body)),
      acceleration_(input_index(system, forces.acceleration)),
      steering_(input_index(system, forces.steering)),
      front_site_(element_index(named, mjOBJ_SITE, forces.front_axle)),
      rear_site_(element_index(named, mjOBJ_SITE, forces.rear_axle)),
      front_stiffness_(forces.front_stiffness),
      rear_stiffness_(forces.rear_stiffness),
      slowest_(forces.slowest),
      mass_(model_.body_subtreemass[body_]) {}

void AxleForceBinding::apply(mjData& data, const Eigen::VectorXd& input) const {
  const PlaneMotion motion = plane_motion(model_, data, body_, body_rotation(data, body_).col(0));
  const Eigen::Vector3d origin = body_origin(data, body_);
  const double slip_speed = std::max(std::abs(motion.speed), slowest_);
  const auto axle = [&](int site, double stiffness, double steering) {
    const Eigen::Vector3d point =
        Eigen::Map<const Eigen::Vector3d>(data.site_xpos + std::ptrdiff_t{3} * site);
    const double ahead = motion.forward.dot(point - origin);
    const double slip = (motion.lateral + ahead * motion.yaw_rate) / slip_speed - steering;
    push(data, body_, -stiffness * slip * motion.left, origin + ahead * motion.forward);
  };
  axle(front_site_, front_stiffness_, input[steering_]);
  axle(rear_site_, rear_stiffness_, 0.0);
  const double along = mass_ * (input[acceleration_] - motion.lateral * motion.yaw_rate);
  push(data, body_, along * motion.forward, origin);
}

void AxleForceBinding::scale_friction(double factor) {
  front_stiffness_ *= factor;
  rear_stiffness_ *= factor;
}

TyreForceBinding::TyreForceBinding(const NamedModel& named, const TyreForces& forces)
    : model_(named.model),
      longitudinal_stiffness_(forces.longitudinal_stiffness),
      friction_(forces.friction),
      slowest_(forces.slowest) {
  for (const TyreWheel& wheel : forces.wheels) {
    const int joint = scalar_joint(named, wheel.joint);
    const int body = model_.jnt_bodyid[joint];
    // A wheel's axle is its principal axis of largest inertia.
    const double* inertia = model_.body_inertia + std::ptrdiff_t{3} * body;
    const int dof = model_.jnt_dofadr[joint];
    wheels_.push_back(
        {.body = body,
         .joint = joint,
         .dof = dof,
         .radius = wheel_radius(named, joint),
         .inertia = *std::max_element(inertia, inertia + 3) + model_.dof_armature[dof],
         .stiffness = wheel.cornering_stiffness});
  }
  loads_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(wheels_.size()));
}

void TyreForceBinding::scale_friction(double factor) {
  friction_ *= factor;
  for (Wheel& wheel : wheels_) wheel.stiffness *= factor;
}

void TyreForceBinding::weigh(const mjData& data) {
  loads_.setZero();
  for (int k = 0; k < data.ncon; ++k) {
    const mjContact& contact = data.contact[k];
    const bool is_upright = std::abs(contact.frame[2]) > kLeastUpright;  // a wall carries nothing
    if (contact.efc_address < 0 || !is_upright) continue;
    for (std::size_t w = 0; w < wheels_.size(); ++w) {
      const int body = wheels_[w].body;
      if (model_.geom_bodyid[contact.geom1] != body && model_.geom_bodyid[contact.geom2] != body) {
        continue;
      }
      std::array<double, 6> force{};
      mj_contactForce(&model_, &data, k, force.data());
      loads_[static_cast<Eigen::Index>(w)] += std::max(0.0, force[0]);
    }
  }
}

void TyreForceBinding::apply(mjData& data) const {
  const double step = model_.opt.timestep;
  const double gravity = Eigen::Map<const Eigen::Vector3d>(model_.opt.gravity).norm();
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    const Wheel& wheel = wheels_[w];
    const double load = loads_[static_cast<Eigen::Index>(w)];
    if (!(load > 0.0)) continue;
    const Eigen::Map<const Eigen::Vector3d> axle(data.xaxis + std::ptrdiff_t{3} * wheel.joint);
    const PlaneMotion motion =
        plane_motion(model_, data, wheel.body, axle.cross(Eigen::Vector3d::UnitZ()));
    const double slip_speed = std::max(std::abs(motion.speed), slowest_);
    const double along_rate = longitudinal_stiffness_ / slip_speed *
                              (wheel.radius * wheel.radius / wheel.inertia + gravity / load);
    const double across_rate = wheel.stiffness / slip_speed * gravity / load;
    const double along = longitudinal_stiffness_ / (1.0 + step * along_rate) *
                         (wheel.radius * data.qvel[wheel.dof] - motion.speed) / slip_speed;
    // Two wheels per axle, and two axles, act on the same slip: stable up to half of the bound for
    // a single force.
    const double across =
        -wheel.stiffness / std::max(1.0, 2.0 * step * across_rate) * motion.lateral / slip_speed;
    const double size = std::hypot(along, across);
    if (!(size > 0.0)) continue;
    const double most = friction_ * load;
    const double share = most * brush(size / most) / size;
    const Eigen::Vector3d ground =
        body_origin(data, wheel.body) - wheel.radius * Eigen::Vector3d::UnitZ();
    push(data, wheel.body, share * (along * motion.forward + across * motion.left), ground);
  }
}

}  // namespace qsmpc::harness
