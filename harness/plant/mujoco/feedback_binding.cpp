#include "harness/plant/mujoco/feedback_binding.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "harness/plant/mujoco/control_binding.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kHeld = "held by feedback";
constexpr double kTestShare = 0.25;  // of the smaller limit of the command

/// The state binding of a system whose only state is the quantity.
StateBinding bind_quantity(const NamedModel& named, mjData& data, const PlantQuantity& quantity) {
  PlantMapping mapping;
  mapping.states[kHeld] = quantity;
  models::SystemDescription system;
  system.states.push_back({.name = kHeld, .unit = ""});
  return StateBinding(named, data, mapping, system);
}

}  // namespace

FeedbackBinding::FeedbackBinding(const NamedModel& named, mjData& data, const FeedbackLoop& loop,
                                 const models::SystemDescription& system,
                                 const models::ParameterMap& parameters)
    : model_(named.model),
      quantity_(bind_quantity(named, data, loop.quantity)),
      goal_gain_(loop.input.empty() ? constant_value(loop.goal, parameters) : loop.goal.gain),
      time_constant_(loop.time_constant),
      response_(loop.response.value_or(0.0)),
      least_(-kInfinity),
      most_(kInfinity) {
  if (!loop.input.empty()) input_ = input_index(system, loop.input);
  for (const ControlTerm& term : loop.actuators) {
    const int actuator = element_index(named, mjOBJ_ACTUATOR, term.actuator);
    outputs_.push_back({.actuator = actuator, .gain = term.gain});
    limit_command(actuator, term.gain);
  }
}

void FeedbackBinding::limit_command(int actuator, double gain) {
  const auto index = static_cast<std::ptrdiff_t>(actuator);
  const auto narrow = [&](const mjtNum* range, double by) {
    const double one = range[0] / by;
    const double other = range[1] / by;
    least_ = std::max(least_, std::min(one, other));
    most_ = std::min(most_, std::max(one, other));
  };
  if (model_.actuator_ctrllimited[actuator]) narrow(model_.actuator_ctrlrange + 2 * index, gain);
  const double force = model_.actuator_gainprm[mjNGAIN * index];
  const bool is_motor = model_.actuator_gaintype[actuator] == mjGAIN_FIXED &&
                        model_.actuator_biastype[actuator] == mjBIAS_NONE && force != 0.0;
  if (is_motor && model_.actuator_forcelimited[actuator]) {
    narrow(model_.actuator_forcerange + 2 * index, gain * force);
  }
}

double FeedbackBinding::value(const mjData& data) const {
  return quantity_.read(data, Eigen::VectorXd::Zero(1))[0];
}

double FeedbackBinding::goal(const Eigen::VectorXd& input) const {
  return input_ < 0 ? goal_gain_ : goal_gain_ * input[input_];
}

double FeedbackBinding::test_command() const {
  const double limit = std::min(most_, -least_);
  return std::isfinite(limit) && limit > 0.0 ? kTestShare * limit : 1.0;
}

void FeedbackBinding::add(double command, Eigen::VectorXd& controls) const {
  for (const Output& output : outputs_) controls[output.actuator] += output.gain * command;
}

void FeedbackBinding::act(const mjData& data, const Eigen::VectorXd& input,
                          Eigen::VectorXd& controls) {
  const double velocity = value(data);
  const double error = goal(input) - velocity;
  const double wanted = (error - velocity + memory_) / (response_ * time_constant_);
  const double command = std::clamp(wanted, least_, most_);
  add(command, controls);
  // Whether the command is saturated and the error would drive it further beyond the limit.
  const bool is_held_back = (wanted - command) * error / response_ > 0.0;
  if (!is_held_back) memory_ += model_.opt.timestep * error / time_constant_;
}

}  // namespace qsmpc::harness
