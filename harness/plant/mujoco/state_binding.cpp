#include "harness/plant/mujoco/state_binding.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/mujoco/mujoco_errors.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;  // rad
// Layout of a free joint: position (3), quaternion (4); linear velocity in world axes (3), angular
// velocity in body axes (3).
constexpr int kQuaternion = 3;
constexpr int kAngularVelocity = 3;
// Steps that bring positions to their goal. Moving a free joint takes one.
constexpr int kMostMoves = 20;
constexpr double kPlaced = 1e-10;  // m or rad
// Rows of a Jacobian are dependent if a pivot, relative to the largest, is below this.
constexpr double kRankThreshold = 1e-9;

using RowJacobian = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;

struct BodyJacobian {
  RowJacobian position;
  RowJacobian rotation;
};

BodyJacobian body_jacobian(const mjModel& model, mjData& data, int body) {
  BodyJacobian jacobian{.position = RowJacobian::Zero(3, model.nv),
                        .rotation = RowJacobian::Zero(3, model.nv)};
  mj_jacBody(&model, &data, jacobian.position.data(), jacobian.rotation.data(), body);
  return jacobian;
}

double yaw_of(const Eigen::Matrix3d& rotation) {
  return std::atan2(rotation(1, 0), rotation(0, 0));
}

}  // namespace

StateBinding::StateBinding(const NamedModel& named, mjData& data, const PlantMapping& mapping,
                           const models::SystemDescription& system)
    : model_(named.model) {
  for (std::size_t i = 0; i < system.states.size(); ++i) {
    const PlantQuantity& quantity = mapping.states.at(system.states[i].name);
    states_.push_back(resolve(named, quantity));
    const Kind kind = states_.back().kind;
    const auto index = static_cast<Eigen::Index>(i);
    const bool is_rate = kind == Kind::kJointVelocity || kind == Kind::kVelocityX ||
                         kind == Kind::kVelocityY || kind == Kind::kForwardSpeed ||
                         kind == Kind::kLateralSpeed || kind == Kind::kYawRate;
    const bool is_read_only = kind == Kind::kSensor || kind == Kind::kRoll || kind == Kind::kPitch;
    if (!is_read_only) (is_rate ? velocities_ : positions_).push_back(index);
    const bool is_heading = index == system.heading;
    if (kind != Kind::kSensor && (is_heading || carrier_ == 0)) carrier_ = states_.back().body;
    if (is_heading && !is_read_only) heading_ = index;
  }
  check_rank(named, data, system);
}

StateBinding::State StateBinding::resolve(const NamedModel& named,
                                          const PlantQuantity& quantity) const {
  State state{.kind = Kind::kSensor,
              .body = 0,
              .address = 0,
              .dof = 0,
              .free_pos = -1,
              .gain = quantity.gain,
              .offset = quantity.offset};
  if (quantity.source == QuantitySource::kSensor) {
    const int sensor = element_index(named, mjOBJ_SENSOR, quantity.element);
    const int size = model_.sensor_dim[sensor];
    if (quantity.component >= size) {
      throw InputError({.file = named.file,
                        .key = "sensor " + quantity.element,
                        .found = fmt::format("component {}", quantity.component),
                        .expected = fmt::format("one of 0 to {}", size - 1)});
    }
    state.address = model_.sensor_adr[sensor] + quantity.component;
    return state;
  }
  if (quantity.source == QuantitySource::kJoint) {
    const int joint = scalar_joint(named, quantity.element);
    const bool is_position = quantity.quantity == joint_quantities().front();
    state.kind = is_position ? Kind::kJointPosition : Kind::kJointVelocity;
    state.address = model_.jnt_qposadr[joint];
    state.dof = model_.jnt_dofadr[joint];
    state.body = model_.jnt_bodyid[joint];
    return state;
  }
  constexpr std::array kKinds = {
      Kind::kX,      Kind::kY,         Kind::kZ,         Kind::kRoll,         Kind::kPitch,
      Kind::kYaw,    Kind::kVelocityX, Kind::kVelocityY, Kind::kForwardSpeed, Kind::kLateralSpeed,
      Kind::kYawRate};
  const auto& names = body_quantities();
  const auto place = std::ranges::find(names, quantity.quantity) - names.begin();
  state.kind = kKinds.at(static_cast<std::size_t>(place));
  state.body = element_index(named, mjOBJ_BODY, quantity.element);
  const int joint = model_.body_jntadr[state.body];
  if (joint >= 0 && model_.jnt_type[joint] == mjJNT_FREE) {
    state.free_pos = model_.jnt_qposadr[joint];
    state.dof = model_.jnt_dofadr[joint];
  }
  return state;
}

void StateBinding::check_rank(const NamedModel& named, mjData& data,
                              const models::SystemDescription& system) const {
  for (const auto* group : {&positions_, &velocities_}) {
    if (group->empty()) continue;
    const Eigen::MatrixXd rows =
        group == &positions_ ? position_jacobian(data) : velocity_jacobian(data);
    const models::ColumnRank found = models::column_rank(rows.transpose(), kRankThreshold);
    if (found.dependent < 0) continue;
    throw InputError({.file = named.file,
                      .key = "state " + system.states[(*group)[found.dependent]].name,
                      .found = "a quantity that nothing moves, or that another state determines",
                      .expected = "one that can be set independently"});
  }
}

double StateBinding::quantity(const mjData& data, const State& state) const {
  const bool is_free = state.free_pos >= 0;
  const auto rotation = [&]() -> Eigen::Matrix3d {
    if (!is_free) return body_rotation(data, state.body);
    const double* q = data.qpos + state.free_pos + kQuaternion;
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  };
  const auto origin = [&]() -> Eigen::Vector3d {
    if (!is_free) return body_origin(data, state.body);
    return Eigen::Map<const Eigen::Vector3d>(data.qpos + state.free_pos);
  };
  // In the world's axes: angular velocity, then velocity of the origin.
  const auto motion = [&]() -> Eigen::Matrix<double, 6, 1> {
    Eigen::Matrix<double, 6, 1> result;
    if (is_free) {
      const Eigen::Map<const Eigen::Vector3d> linear(data.qvel + state.dof);
      const Eigen::Map<const Eigen::Vector3d> angular(data.qvel + state.dof + kAngularVelocity);
      result << rotation() * angular, linear;
    } else {
      mj_objectVelocity(&model_, &data, mjOBJ_XBODY, state.body, result.data(), 0);
    }
    return result;
  };
  switch (state.kind) {
    case Kind::kJointPosition:
      return data.qpos[state.address];
    case Kind::kJointVelocity:
      return data.qvel[state.dof];
    case Kind::kX:
      return origin().x();
    case Kind::kY:
      return origin().y();
    case Kind::kZ:
      return origin().z();
    case Kind::kRoll: {
      const Eigen::Matrix3d r = rotation();
      return std::atan2(r(2, 1), r(2, 2));
    }
    case Kind::kPitch:
      return std::asin(std::clamp(-rotation()(2, 0), -1.0, 1.0));
    case Kind::kYaw:
      return yaw_of(rotation());
    case Kind::kVelocityX:
      return motion()[3];
    case Kind::kVelocityY:
      return motion()[4];
    case Kind::kForwardSpeed:
    case Kind::kLateralSpeed: {
      const double yaw = yaw_of(rotation());
      const Eigen::Vector2d velocity = motion().segment<2>(3);
      return state.kind == Kind::kForwardSpeed
                 ? std::cos(yaw) * velocity.x() + std::sin(yaw) * velocity.y()
                 : std::cos(yaw) * velocity.y() - std::sin(yaw) * velocity.x();
    }
    case Kind::kYawRate:
      return motion()[2];
    case Kind::kSensor:
      return data.sensordata[state.address];
  }
  return 0.0;
}

Eigen::VectorXd StateBinding::read(const mjData& data, const Eigen::VectorXd& near) const {
  Eigen::VectorXd result(size());
  for (Eigen::Index i = 0; i < size(); ++i) {
    const State& state = states_[i];
    double value = state.gain * quantity(data, state) + state.offset;
    if (state.kind == Kind::kYaw) {
      const double turn = std::abs(state.gain) * kTurn;
      value = near[i] + std::remainder(value - near[i], turn);
    }
    result[i] = value;
  }
  return result;
}

Eigen::RowVectorXd StateBinding::gradient(mjData& data, const State& state) const {
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(model_.nv);
  if (state.kind == Kind::kJointPosition || state.kind == Kind::kJointVelocity) {
    row[state.dof] = 1.0;
    return state.gain * row;
  }
  const BodyJacobian jacobian = body_jacobian(model_, data, state.body);
  const double yaw = yaw_of(body_rotation(data, state.body));
  switch (state.kind) {
    case Kind::kX:
    case Kind::kVelocityX:
      row = jacobian.position.row(0);
      break;
    case Kind::kY:
    case Kind::kVelocityY:
      row = jacobian.position.row(1);
      break;
    case Kind::kZ:
      row = jacobian.position.row(2);
      break;
    case Kind::kForwardSpeed:
      row = std::cos(yaw) * jacobian.position.row(0) + std::sin(yaw) * jacobian.position.row(1);
      break;
    case Kind::kLateralSpeed:
      row = std::cos(yaw) * jacobian.position.row(1) - std::sin(yaw) * jacobian.position.row(0);
      break;
    default:
      row = jacobian.rotation.row(2);
  }
  return state.gain * row;
}

Eigen::MatrixXd StateBinding::position_jacobian(mjData& data) const {
  Eigen::MatrixXd rows(positions_.size(), model_.nv);
  for (std::size_t k = 0; k < positions_.size(); ++k) {
    rows.row(static_cast<Eigen::Index>(k)) = gradient(data, states_[positions_[k]]);
  }
  return rows;
}

Eigen::MatrixXd StateBinding::velocity_jacobian(mjData& data) const {
  Eigen::MatrixXd rows(velocities_.size(), model_.nv);
  for (std::size_t k = 0; k < velocities_.size(); ++k) {
    rows.row(static_cast<Eigen::Index>(k)) = gradient(data, states_[velocities_[k]]);
  }
  return rows;
}

void StateBinding::move(mjData& data, const Eigen::VectorXd& change) const {
  if (positions_.empty()) return;
  const Eigen::VectorXd wanted = change(positions_);
  if (wanted.isZero(0.0)) return;
  const Eigen::VectorXd start = read(data, Eigen::VectorXd::Zero(size()));
  const Eigen::VectorXd goal = start + change;
  Eigen::VectorXd left = wanted;
  for (int k = 0; k < kMostMoves && left.cwiseAbs().maxCoeff() > kPlaced; ++k) {
    const Eigen::VectorXd step = models::smallest_solution(position_jacobian(data), left);
    if (!step.allFinite()) break;
    mj_integratePos(&model_, data.qpos, step.data(), 1.0);
    mj_kinematics(&model_, &data);
    mj_comPos(&model_, &data);
    left = (goal - read(data, goal))(positions_);
  }
  // The negation also catches NaN.
  const double scale = std::max(1.0, goal(positions_).cwiseAbs().maxCoeff());
  if (!(left.cwiseAbs().maxCoeff() <= kPlaced * scale)) {
    throw MujocoError("the model cannot be placed at the state");
  }
}

/// Updates the velocities after a turn: the carrier's velocity turns with it, then the change of
/// the states is added.
void StateBinding::accelerate(mjData& data, const Eigen::VectorXd& change, double turn,
                              const Eigen::Vector3d& velocity) const {
  Eigen::Map<Eigen::VectorXd> generalised(data.qvel, model_.nv);
  if (turn != 0.0 && carrier_ > 0) {
    const Eigen::Vector3d turned =
        Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix() * velocity;
    const Eigen::MatrixXd along = body_jacobian(model_, data, carrier_).position.topRows(2);
    const Eigen::VectorXd missing = turned.head<2>() - along * generalised;
    generalised += models::smallest_solution(along, missing);
  }
  if (velocities_.empty() || change(velocities_).isZero(0.0)) return;
  generalised += models::smallest_solution(velocity_jacobian(data), change(velocities_));
}

void StateBinding::add(mjData& data, const Eigen::VectorXd& change) const {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  if (carrier_ > 0) {
    const Eigen::Map<const Eigen::VectorXd> generalised(data.qvel, model_.nv);
    velocity = body_jacobian(model_, data, carrier_).position * generalised;
  }
  move(data, change);
  double turn = 0.0;
  if (heading_ >= 0) turn = change[heading_] / states_[heading_].gain;
  accelerate(data, change, turn, velocity);
  mj_forward(&model_, &data);
}

bool StateBinding::is_writable(Eigen::Index state) const {
  return std::ranges::find(positions_, state) != positions_.end() ||
         std::ranges::find(velocities_, state) != velocities_.end();
}

bool StateBinding::has_velocity() const { return !velocities_.empty(); }

}  // namespace qsmpc::harness
