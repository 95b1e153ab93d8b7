// plant_mapping_text: writes what plant_mapping_reader.hpp reads.
#include <utility>

#include <fmt/format.h>

#include "harness/scenario/plant_mapping_reader.hpp"
#include "harness/scenario/yaml_text.hpp"

namespace qsmpc::harness {
namespace {

/// "[a, b]", where `text` writes each item.
template <class Items, class Text>
std::string list_of(const Items& items, Text text) {
  std::string out = "[";
  for (const auto& item : items) out += (out.size() == 1 ? "" : ", ") + text(item);
  return out + "]";
}

std::string quantity_text(const PlantQuantity& quantity) {
  std::string out;
  switch (quantity.source) {
    case QuantitySource::kSensor:
      out = fmt::format("sensor: {}, component: {}", quoted_yaml(quantity.element),
                        quantity.component);
      break;
    case QuantitySource::kBody:
    case QuantitySource::kJoint:
      out = fmt::format("{}: {}, quantity: {}",
                        quantity.source == QuantitySource::kBody ? "body" : "joint",
                        quoted_yaml(quantity.element), quantity.quantity);
      break;
  }
  return fmt::format("{{{}, gain: {}, offset: {}}}", out, yaml_number(quantity.gain),
                     yaml_number(quantity.offset));
}

std::string constant_text(const PlantConstant& constant) {
  const std::string parameter =
      constant.parameter.empty() ? "" : fmt::format("parameter: {}, ", constant.parameter);
  return fmt::format("{}gain: {}", parameter, yaml_number(constant.gain));
}

struct LoopText {
  std::string operator()(const AckermannLoop& loop) const {
    const std::string speed =
        loop.speed ? fmt::format("speed: {{{}}}, ", constant_text(*loop.speed)) : "";
    const auto wheel = [](const SteeredWheel& one) {
      return fmt::format("{{joint: {}, actuator: {}}}", quoted_yaml(one.joint),
                         quoted_yaml(one.actuator));
    };
    return fmt::format("{{kind: ackermann, input: {}, {}wheels: {}, fixed_axle: {}}}", loop.input,
                       speed, list_of(loop.wheels, wheel), list_of(loop.fixed_axle, quoted_yaml));
  }

  std::string operator()(const SpeedHoldLoop& loop) const {
    return fmt::format("{{kind: speed_hold, speed: {{{}}}, actuator: {}, wheel: {}}}",
                       constant_text(loop.speed), quoted_yaml(loop.actuator),
                       quoted_yaml(loop.wheel));
  }

  std::string operator()(const AxleForces& loop) const {
    return fmt::format(
        "{{kind: axle_forces, body: {}, acceleration: {}, steering: {}, front_axle: {}, "
        "rear_axle: {}, front_stiffness: {}, rear_stiffness: {}, slowest: {}}}",
        quoted_yaml(loop.body), loop.acceleration, loop.steering, quoted_yaml(loop.front_axle),
        quoted_yaml(loop.rear_axle), yaml_number(loop.front_stiffness),
        yaml_number(loop.rear_stiffness), yaml_number(loop.slowest));
  }

  std::string operator()(const TyreForces& loop) const {
    const auto wheel = [](const TyreWheel& one) {
      return fmt::format("{{joint: {}, cornering_stiffness: {}}}", quoted_yaml(one.joint),
                         yaml_number(one.cornering_stiffness));
    };
    return fmt::format(
        "{{kind: tyre_forces, wheels: {}, longitudinal_stiffness: {}, friction: {}, slowest: {}}}",
        list_of(loop.wheels, wheel), yaml_number(loop.longitudinal_stiffness),
        yaml_number(loop.friction), yaml_number(loop.slowest));
  }

  std::string operator()(const FeedbackLoop& loop) const {
    const std::string goal = loop.input.empty() ? constant_text(loop.goal)
                                                : fmt::format("input: {}, gain: {}", loop.input,
                                                              yaml_number(loop.goal.gain));
    const auto actuator = [](const ControlTerm& one) {
      return fmt::format("{{actuator: {}, gain: {}}}", quoted_yaml(one.actuator),
                         yaml_number(one.gain));
    };
    const std::string response =
        loop.response ? fmt::format(", response: {}", yaml_number(*loop.response)) : "";
    return fmt::format(
        "{{kind: feedback, quantity: {}, goal: {{{}}}, actuators: {}, time_constant: {}{}}}",
        quantity_text(loop.quantity), goal, list_of(loop.actuators, actuator),
        yaml_number(loop.time_constant), response);
  }

  std::string operator()(const GaitLoop& loop) const {
    const auto swing = [](const GaitSwing& one) {
      const std::string input = one.input.empty() ? ""
                                                  : fmt::format(", input: {}, gain: {}", one.input,
                                                                yaml_number(one.gain));
      return fmt::format("{{actuator: {}, amplitude: {}, phase: {}{}}}", quoted_yaml(one.actuator),
                         yaml_number(one.amplitude), yaml_number(one.phase), input);
    };
    return fmt::format("{{kind: gait, cycle: {}, actuators: {}}}", yaml_number(loop.cycle),
                       list_of(loop.actuators, swing));
  }
};

std::string inputs_text(const PlantMapping& mapping) {
  const auto term = [](const ControlTerm& one) {
    return fmt::format("{{actuator: {}, gain: {}, offset: {}}}", quoted_yaml(one.actuator),
                       yaml_number(one.gain), yaml_number(one.offset));
  };
  std::string out;
  for (const auto& [name, terms] : mapping.inputs) {
    out += fmt::format("{}{}: {}", out.empty() ? "" : ", ", name, list_of(terms, term));
  }
  return out;
}

}  // namespace

std::string plant_loop_text(const PlantLoop& loop) { return std::visit(LoopText{}, loop); }

std::string plant_mapping_text(const PlantMapping& mapping) {
  std::string states;
  for (const auto& [name, quantity] : mapping.states) {
    states += fmt::format("{}{}: {}", states.empty() ? "" : ", ", name, quantity_text(quantity));
  }
  const auto hold = [](const HoldTerm& term) {
    return fmt::format("{{actuator: {}, {}}}", quoted_yaml(term.actuator),
                       constant_text(term.constant));
  };
  std::string limits;
  for (const auto& [actuator, rate] : mapping.rate_limits) {
    limits += fmt::format("{}{}: {}", limits.empty() ? "" : ", ", quoted_yaml(actuator),
                          yaml_number(rate));
  }
  std::string out = fmt::format(
      "state: {{{}}}, input: {{{}}}, hold: {}, loops: {}, rolling: {}, rate_limit: {{{}}}, "
      "input_delay: {}, settling: {}",
      states, inputs_text(mapping), list_of(mapping.holds, hold),
      list_of(mapping.loops, plant_loop_text), list_of(mapping.rolling, quoted_yaml), limits,
      yaml_number(mapping.input_delay), yaml_number(mapping.settling));
  if (mapping.time_steps) {
    out += fmt::format(", time_steps: [{}, {}]", yaml_number(mapping.time_steps->least),
                       yaml_number(mapping.time_steps->most));
  }
  return out;
}

}  // namespace qsmpc::harness
