#include "harness/scenario/plant_mapping_keys.hpp"

#include <utility>

#include <fmt/format.h>

#include "harness/scenario/plant_mapping.hpp"

namespace qsmpc::harness {
namespace {

KeyDescription element_key(const char* name, const char* words, bool required = true) {
  return {.name = name,
          .values = {TextValue{.longest = kLongestElement, .what = "a name"}},
          .words = words,
          .required = required};
}

KeyDescription gain_key(const char* words) {
  return {.name = "gain", .values = {NumberValue{}}, .words = words, .fallback = "1"};
}

KeyDescription offset_key() {
  return {.name = "offset", .values = {NumberValue{}}, .words = "added to that", .fallback = "0"};
}

KeyDescription parameter_key() {
  return {.name = "parameter",
          .values = {SystemNameValue{NameFamily::kParameters}},
          .words = "a constant of the system; without one, the gain alone"};
}

KeyDescription positive_key(const char* name, const char* words, const char* unit) {
  return {.name = name, .values = {NumberValue{kPositive}}, .words = words, .unit = unit};
}

ListValue mappings(std::vector<KeyDescription> keys) {
  return list_of_values(MappingValue{std::move(keys)}, {.most = kMostMappingItems});
}

ListValue elements() {
  return list_of_values(TextValue{.longest = kLongestElement, .what = "a name"});
}

MappingValue quantity() {
  std::vector<std::string> quantities = joint_quantities();
  quantities.insert(quantities.end(), body_quantities().begin(), body_quantities().end());
  return {{element_key("joint", "a slide or hinge joint", false),
           element_key("body", "a body; the quantity is that of its origin", false),
           element_key("sensor", "a sensor", false),
           {.name = "quantity",
            .values = {NameValue{std::move(quantities)}},
            .words = "`position` or `velocity` of a joint, the others of a body"},
           {.name = "component",
            .values = {WholeValue{kComponentRange.least, kComponentRange.most}},
            .words = "which of a sensor's numbers",
            .fallback = "0"},
           gain_key("factor on the quantity, not 0"),
           offset_key()}};
}

/// The keys of all kinds of loops together; `kind` determines which of them apply.
std::vector<KeyDescription> loop_keys() {
  const SystemNameValue input{NameFamily::kInputs};
  const MappingValue speed{{parameter_key(), gain_key("factor on the constant; without one, m/s")}};
  const ListValue wheels = mappings(
      {element_key("joint", "joint that the wheel turns about"),
       element_key("actuator", "servo that steers it, `ackermann` only", false),
       positive_key("cornering_stiffness", "stiffness of its tyre, `tyre_forces` only", "N/rad")});
  const MappingValue goal{
      {{.name = "input", .values = {input}, .words = "input that the goal follows"},
       parameter_key(),
       gain_key("factor on either; without one, the goal itself")}};
  const ListValue actuators = mappings(
      {element_key("actuator", "actuator that exerts a force or torque; `gait`: that swings"),
       gain_key("its share of the command, not 0; `gait`: of the input in its amplitude, not 0"),
       {.name = "amplitude",
        .values = {NumberValue{}},
        .words = "`gait` only: of the control, to which gain · input is added",
        .fallback = "0"},
       {.name = "input",
        .values = {input},
        .words = "`gait` only: an input that the amplitude depends on"},
       {.name = "phase",
        .values = {NumberValue{}},
        .words = "`gait` only: lead, as a share of a cycle",
        .fallback = "0"}});
  return {
      {.name = "kind",
       .values = {NameValue{loop_kind_names()}},
       .words = "kind of the loop",
       .required = true},
      {.name = "input", .values = {input}, .words = "`ackermann`: the yaw rate or steering angle"},
      {.name = "speed", .values = {speed}, .words = "`ackermann`, `speed_hold`: m/s"},
      {.name = "wheels",
       .values = {wheels},
       .words = "`ackermann`: the steered wheels; `tyre_forces`: all wheels"},
      {.name = "quantity",
       .values = {quantity()},
       .words = "`feedback`: the velocity that is held"},
      {.name = "goal", .values = {goal}, .words = "`feedback`: the value at which it is held"},
      {.name = "actuators",
       .values = {actuators},
       .words = "`feedback`: the actuators that hold it; `gait`: those that it moves"},
      positive_key("cycle", "`gait`: duration of a cycle", "s"),
      positive_key("time_constant", "`feedback`: time constant of the lag behind the goal", "s"),
      {.name = "response",
       .values = {NumberValue{}},
       .words = "`feedback`: rate of change of the velocity per unit of the command, not 0; "
                "measured if omitted"},
      {.name = "fixed_axle",
       .values = {elements()},
       .words = "`ackermann`: joints of the wheels that are not steered"},
      element_key("actuator", "`speed_hold`: a velocity servo, rad/s", false),
      element_key("wheel", "`speed_hold`: joint of a driven wheel", false),
      element_key("body", "`axle_forces`: a body that moves in the plane", false),
      {.name = "acceleration", .values = {input}, .words = "`axle_forces`: the input, m/s²"},
      {.name = "steering", .values = {input}, .words = "`axle_forces`: the input, rad"},
      element_key("front_axle", "`axle_forces`: a site", false),
      element_key("rear_axle", "`axle_forces`: a site", false),
      positive_key("front_stiffness", "`axle_forces`: stiffness of the axle", "N/rad"),
      positive_key("rear_stiffness", "`axle_forces`: stiffness of the axle", "N/rad"),
      positive_key("longitudinal_stiffness", "`tyre_forces`: stiffness of a tyre, per unit of slip",
                   "N"),
      positive_key("friction", "`tyre_forces`: coefficient of friction", ""),
      positive_key("slowest",
                   "speed below which slip is computed as if the vehicle moved at this speed",
                   "m/s")};
}

std::vector<KeyDescription> actuation_keys() {
  const ListValue terms = mappings({element_key("actuator", "actuator that the input acts on"),
                                    gain_key("factor on the input, not 0"), offset_key()});
  const ListValue holds =
      mappings({element_key("actuator", "actuator whose control it is added to"), parameter_key(),
                gain_key("factor on the constant")});
  return {{.name = "input",
           .values = {MappingValue{
               {{.name = "INPUT",
                 .family = NameFamily::kInputs,
                 .values = {terms},
                 .words = "list of `{actuator, gain, offset}`: the control of an actuator is the "
                          "sum of gain · input + offset over all entries that name it",
                 .fallback_words = "none: then a loop must use the input"}}}}},
          {.name = "hold",
           .values = {holds},
           .words = "list of `{actuator, parameter, gain}`: adds gain times the constant "
                    "`parameter` of the system, or the gain alone, to a control",
           .fallback_words = "none"},
          {.name = "loops",
           .values = {mappings(loop_keys())},
           .words = "list of [low-level loops](#low-level-loops)",
           .fallback_words = "none"},
          {.name = "rolling",
           .values = {elements()},
           .words = "joints of wheels that are set spinning when the vehicle is placed at a speed",
           .fallback_words = "none"},
          {.name = "rate_limit",
           .values = {MappingValue{{{.name = "ACTUATOR",
                                     .family = NameFamily::kFree,
                                     .values = {NumberValue{kPositive}},
                                     .words = "maximum rate of change of the control",
                                     .unit = "of the control per s",
                                     .fallback_words = "not limited"}}}}}};
}

std::vector<KeyDescription> timing_keys() {
  const PlantMapping defaults;
  return {{.name = "input_delay",
           .values = {NumberValue{kInputDelayRange}},
           .words = "delay before an input acts",
           .unit = "s",
           .fallback = fmt::format("{}", defaults.input_delay)},
          {.name = "settling",
           .values = {NumberValue{kSettlingRange}},
           .words = "time, {range}, for which the vehicle runs with zero inputs before it is first "
                    "placed: it comes to rest on its springs and reaches the speed that it holds",
           .unit = "s",
           .fallback = fmt::format("{}", defaults.settling)},
          {.name = "time_steps",
           .values = {VectorValue{.size = Dimension::kAny, .length = 2, .range = kPositive}},
           .words = "`[least, most]`: the range of simulator time steps that the vehicle was made "
                    "for; others are refused",
           .unit = "s",
           .fallback_words = "any"}};
}

std::vector<KeyDescription> mapping_keys() {
  std::vector<KeyDescription> keys{
      {.name = "state",
       .values = {MappingValue{{{.name = "STATE",
                                 .family = NameFamily::kStates,
                                 .values = {quantity()},
                                 .words = "a [quantity](#quantities) for each state of the system",
                                 .required = true}}}}}};
  for (KeyDescription& key : actuation_keys()) keys.push_back(std::move(key));
  for (KeyDescription& key : timing_keys()) keys.push_back(std::move(key));
  return keys;
}

}  // namespace

const std::vector<std::string>& loop_kind_names() {
  static const std::vector<std::string> names{"ackermann",   "speed_hold", "axle_forces",
                                              "tyre_forces", "feedback",   "gait"};
  return names;
}

const std::vector<KeyDescription>& plant_mapping_keys() {
  static const std::vector<KeyDescription> all = mapping_keys();
  return all;
}

}  // namespace qsmpc::harness
