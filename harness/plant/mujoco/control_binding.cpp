#include "harness/plant/mujoco/control_binding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "harness/errors.hpp"

namespace qsmpc::harness {
namespace {

double positive_speed(const PlantConstant& constant, const models::ParameterMap& parameters) {
  const double speed = constant_value(constant, parameters);
  if (speed > 0.0 && std::isfinite(speed)) return speed;
  throw InputError(
      {.key = constant.parameter.empty() ? "plant.loops" : "model." + constant.parameter,
       .found = fmt::format("{}", speed),
       .expected = "a speed above 0 m/s: a car at rest cannot turn"});
}

}  // namespace

double constant_value(const PlantConstant& constant, const models::ParameterMap& parameters) {
  if (constant.parameter.empty()) return constant.gain;
  const auto found = parameters.find(constant.parameter);
  if (found != parameters.end()) return constant.gain * found->second;
  std::string known;
  for (const auto& [name, value] : parameters) known += (known.empty() ? "" : ", ") + name;
  throw InputError({.key = "parameter " + constant.parameter,
                    .found = "no such constant of the system",
                    .expected = known.empty() ? "none" : "one of " + known});
}

Eigen::Index input_index(const models::SystemDescription& system, const std::string& name) {
  const auto found = std::ranges::find_if(
      system.inputs, [&](const models::Coordinate& one) { return one.name == name; });
  return found - system.inputs.begin();
}

ControlBinding::ControlBinding(const NamedModel& named, const mjData& data,
                               const PlantMapping& mapping, const models::SystemDescription& system,
                               const models::ParameterMap& parameters)
    : model_(named.model),
      most_change_(
          Eigen::VectorXd::Constant(named.model.nu, std::numeric_limits<double>::infinity())) {
  for (const auto& [name, terms] : mapping.inputs) {
    for (const ControlTerm& term : terms) {
      terms_.push_back({.input = input_index(system, name),
                        .actuator = element_index(named, mjOBJ_ACTUATOR, term.actuator),
                        .gain = term.gain,
                        .offset = term.offset});
    }
  }
  for (const HoldTerm& hold : mapping.holds) {
    constants_.push_back({.actuator = element_index(named, mjOBJ_ACTUATOR, hold.actuator),
                          .value = constant_value(hold.constant, parameters)});
  }
  for (const PlantLoop& loop : mapping.loops) {
    if (const auto* steering = std::get_if<AckermannLoop>(&loop)) {
      add(named, data, *steering, system, parameters);
    } else if (const auto* hold = std::get_if<SpeedHoldLoop>(&loop)) {
      add(named, *hold, parameters);
    }
  }
  for (const auto& [actuator, rate] : mapping.rate_limits) {
    most_change_[element_index(named, mjOBJ_ACTUATOR, actuator)] = rate * model_.opt.timestep;
  }
}

void ControlBinding::add(const NamedModel& named, const mjData& data, const AckermannLoop& loop,
                         const models::SystemDescription& system,
                         const models::ParameterMap& parameters) {
  const int root =
      model_.body_rootid[model_.jnt_bodyid[scalar_joint(named, loop.wheels.front().joint)]];
  Eigen::Vector3d axle = Eigen::Vector3d::Zero();
  for (const std::string& name : loop.fixed_axle) {
    axle += anchor_in_body(data, scalar_joint(named, name), root);
  }
  axle /= static_cast<double>(loop.fixed_axle.size());
  Ackermann bound{.input = input_index(system, loop.input),
                  .speed = loop.speed ? positive_speed(*loop.speed, parameters) : 0.0,
                  .wheelbase = 0.0,
                  .wheels = {}};
  for (const auto& wheel : loop.wheels) {
    const Eigen::Vector3d offset =
        anchor_in_body(data, scalar_joint(named, wheel.joint), root) - axle;
    if (!(offset.x() > 0.0)) {
      throw InputError({.file = named.file,
                        .key = "joint " + wheel.joint,
                        .found = fmt::format("{} m ahead of the fixed axle", offset.x()),
                        .expected = "a steered wheel ahead of it"});
    }
    bound.wheels.push_back({.actuator = element_index(named, mjOBJ_ACTUATOR, wheel.actuator),
                            .forward = offset.x(),
                            .left = offset.y()});
    bound.wheelbase += offset.x() / static_cast<double>(loop.wheels.size());
  }
  ackermann_.push_back(std::move(bound));
}

void ControlBinding::add(const NamedModel& named, const SpeedHoldLoop& loop,
                         const models::ParameterMap& parameters) {
  const int joint = scalar_joint(named, loop.wheel);
  const double speed = positive_speed(loop.speed, parameters);
  speed_holds_.push_back({.speed = speed,
                          .actuator = element_index(named, mjOBJ_ACTUATOR, loop.actuator),
                          .command = speed / wheel_radius(named, joint),
                          .body = model_.body_rootid[model_.jnt_bodyid[joint]]});
}

// On a body that moves at v and yaws at ω about the middle of its axle, the point (forward, left)
// has the velocity (v − ω left, ω forward); the wheel there must be aligned with it.
Eigen::VectorXd ControlBinding::targets(const Eigen::VectorXd& input) const {
  Eigen::VectorXd controls = Eigen::VectorXd::Zero(model_.nu);
  for (const Term& term : terms_)
    controls[term.actuator] += term.gain * input[term.input] + term.offset;
  for (const Constant& constant : constants_) controls[constant.actuator] += constant.value;
  for (const SpeedHold& hold : speed_holds_) controls[hold.actuator] += hold.command;
  for (const Ackermann& steering : ackermann_) {
    const double value = input[steering.input];
    const bool is_angle = steering.speed == 0.0;
    const double yaw_rate = is_angle ? std::sin(value) : value;
    const double speed = is_angle ? std::cos(value) * steering.wheelbase : steering.speed;
    for (const SteeredWheel& wheel : steering.wheels) {
      controls[wheel.actuator] +=
          std::atan2(yaw_rate * wheel.forward, speed - yaw_rate * wheel.left);
    }
  }
  return controls;
}

void ControlBinding::follow(mjData& data, const Eigen::VectorXd& targets) const {
  for (int i = 0; i < model_.nu; ++i) {
    const double change = std::clamp(targets[i] - data.ctrl[i], -most_change_[i], most_change_[i]);
    data.ctrl[i] = std::isinf(most_change_[i]) ? targets[i] : data.ctrl[i] + change;
  }
}

}  // namespace qsmpc::harness
