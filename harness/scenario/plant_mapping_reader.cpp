#include "harness/scenario/plant_mapping_reader.hpp"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/plant_mapping_keys.hpp"
#include "harness/scenario/section_values.hpp"
#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {
namespace {

class MappingReader {
 public:
  MappingReader(Section& section, const MappedSystem& system)
      : section_(section), system_(system) {}

  PlantMapping read() {
    read_states();
    read_inputs();
    const std::size_t holds = count(section_, "hold");
    for (std::size_t i = 0; i < holds; ++i) {
      Section item = section_.item("hold", i);
      mapping_.holds.push_back({.actuator = element(item, "actuator"), .constant = constant(item)});
      item.refuse_unread();
    }
    const std::size_t loops = count(section_, "loops");
    for (std::size_t i = 0; i < loops; ++i) read_loop(i);
    mapping_.rolling = section_.texts("rolling", kLongestElement);
    read_timing();
    require_inputs();
    return std::move(mapping_);
  }

 private:
  std::string element(Section& section, const std::string& key) {
    section.require(key, "the name of an element of the MuJoCo model");
    return section.text(key, "", kLongestElement);
  }

  double not_zero(Section& section, const std::string& key) {
    const double value = section.number(key, 1.0);
    if (value == 0.0) section.note(key, "a number other than 0");
    return value;
  }

  static double positive(Section& section, const std::string& key) {
    section.require(key, "a number above 0");
    return section.number(key, 1.0, kPositive);
  }

  static std::size_t count(Section& section, const std::string& key) {
    const std::size_t size = section.list_size(key);
    if (size > kMostMappingItems)
      section.note(key, fmt::format("at most {} items", kMostMappingItems));
    return std::min(size, kMostMappingItems);
  }

  PlantConstant constant(Section& section) {
    PlantConstant result;
    std::vector<std::string> known;
    for (const auto& [name, value] : system_.parameters) known.push_back(name);
    if (section.has("parameter")) {
      result.parameter = section.name("parameter", "", known);
    } else {
      section.require("gain", "a number, or a `parameter` of the system");
    }
    result.gain = section.number("gain", 1.0);
    return result;
  }

  PlantConstant constant_under(Section& section, const std::string& key) {
    section.require(key, "a mapping with `parameter` or `gain`");
    Section inner = section.section(key);
    PlantConstant result = constant(inner);
    inner.refuse_unread();
    return result;
  }

  std::string input_name(Section& section, const std::string& key) {
    section.require(key, "an input of the system");
    std::string name = section.name(key, "", coordinate_names(system_.description.inputs));
    used_.insert(name);
    return name;
  }

  void read_states() {
    Section states = section_.section("state");
    for (const std::string& name : coordinate_names(system_.description.states)) {
      states.require(name, "where the MuJoCo model has it: a joint, body or sensor");
      if (!states.has(name)) continue;
      Section item = states.section(name);
      if (item.present()) mapping_.states[name] = quantity(item);
    }
    states.refuse_unread();
  }

  PlantQuantity quantity(Section& item) {
    PlantQuantity result;
    const int sources = item.has("joint") + item.has("body") + item.has("sensor");
    if (sources != 1) {
      item.note_here("exactly one of joint, body and sensor",
                     sources == 0 ? "none" : "more than one");
    }
    if (item.has("sensor")) {
      result.source = QuantitySource::kSensor;
      result.element = element(item, "sensor");
      result.component = item.whole("component", 0, kComponentRange);
    } else if (item.has("body")) {
      result.source = QuantitySource::kBody;
      result.element = element(item, "body");
      item.require("quantity", expected_names("", body_quantities()));
      result.quantity = item.name("quantity", "x", body_quantities());
    } else {
      result.element = element(item, "joint");
      result.quantity = item.name("quantity", "position", joint_quantities());
    }
    result.gain = not_zero(item, "gain");
    result.offset = item.number("offset", 0.0);
    item.refuse_unread();
    return result;
  }

  void read_inputs() {
    Section inputs = section_.section("input");
    for (const std::string& name : coordinate_names(system_.description.inputs)) {
      const std::size_t terms = count(inputs, name);
      for (std::size_t i = 0; i < terms; ++i) {
        Section item = inputs.item(name, i);
        mapping_.inputs[name].push_back({.actuator = element(item, "actuator"),
                                         .gain = not_zero(item, "gain"),
                                         .offset = item.number("offset", 0.0)});
        item.refuse_unread();
        used_.insert(name);
      }
    }
    inputs.refuse_unread();
  }

  void read_loop(std::size_t index) {
    Section loop = section_.item("loops", index);
    if (!loop.present()) return;
    loop.require("kind", expected_names("", loop_kind_names()));
    const std::string kind = loop.name("kind", "", loop_kind_names());
    if (kind == "ackermann") mapping_.loops.emplace_back(ackermann(loop));
    if (kind == "speed_hold") {
      mapping_.loops.emplace_back(SpeedHoldLoop{.speed = constant_under(loop, "speed"),
                                                .actuator = element(loop, "actuator"),
                                                .wheel = element(loop, "wheel")});
    }
    if (kind == "axle_forces") mapping_.loops.emplace_back(axle_forces(loop));
    if (kind == "tyre_forces") mapping_.loops.emplace_back(tyre_forces(loop));
    if (kind == "feedback") mapping_.loops.emplace_back(feedback(loop));
    if (kind == "gait") mapping_.loops.emplace_back(gait(loop));
    if (!kind.empty()) loop.refuse_unread();
  }

  AckermannLoop ackermann(Section& loop) {
    AckermannLoop result{.input = input_name(loop, "input"),
                         .speed = {},
                         .wheels = {},
                         .fixed_axle = loop.texts("fixed_axle", kLongestElement)};
    if (loop.has("speed")) result.speed = constant_under(loop, "speed");
    const std::size_t wheels = count(loop, "wheels");
    for (std::size_t i = 0; i < wheels; ++i) {
      Section wheel = loop.item("wheels", i);
      result.wheels.push_back(
          {.joint = element(wheel, "joint"), .actuator = element(wheel, "actuator")});
      wheel.refuse_unread();
    }
    if (wheels == 0) loop.note("wheels", "a list of at least one wheel");
    if (result.fixed_axle.empty()) loop.note("fixed_axle", "a list of at least one joint");
    return result;
  }

  AxleForces axle_forces(Section& loop) {
    return {.body = element(loop, "body"),
            .acceleration = input_name(loop, "acceleration"),
            .steering = input_name(loop, "steering"),
            .front_axle = element(loop, "front_axle"),
            .rear_axle = element(loop, "rear_axle"),
            .front_stiffness = positive(loop, "front_stiffness"),
            .rear_stiffness = positive(loop, "rear_stiffness"),
            .slowest = positive(loop, "slowest")};
  }

  TyreForces tyre_forces(Section& loop) {
    TyreForces result{.wheels = {},
                      .longitudinal_stiffness = positive(loop, "longitudinal_stiffness"),
                      .friction = positive(loop, "friction"),
                      .slowest = positive(loop, "slowest")};
    const std::size_t wheels = count(loop, "wheels");
    for (std::size_t i = 0; i < wheels; ++i) {
      Section wheel = loop.item("wheels", i);
      result.wheels.push_back({.joint = element(wheel, "joint"),
                               .cornering_stiffness = positive(wheel, "cornering_stiffness")});
      wheel.refuse_unread();
    }
    if (wheels == 0) loop.note("wheels", "a list of at least one wheel");
    return result;
  }

  FeedbackLoop feedback(Section& loop) {
    FeedbackLoop result;
    loop.require("quantity", "a velocity: of a joint, body or sensor");
    Section held = loop.section("quantity");
    if (held.present()) result.quantity = quantity(held);
    const auto& known = velocity_quantities();
    const bool is_velocity = result.quantity.source == QuantitySource::kSensor ||
                             std::ranges::find(known, result.quantity.quantity) != known.end();
    if (held.present() && !is_velocity) {
      loop.note("quantity", "a velocity: " + expected_names("", known), result.quantity.quantity);
    }
    read_goal(loop, result);
    const std::size_t actuators = count(loop, "actuators");
    for (std::size_t i = 0; i < actuators; ++i) {
      Section item = loop.item("actuators", i);
      result.actuators.push_back(
          {.actuator = element(item, "actuator"), .gain = not_zero(item, "gain")});
      item.refuse_unread();
    }
    if (actuators == 0) loop.note("actuators", "a list of at least one actuator");
    result.time_constant = loop.number("time_constant", result.time_constant, kPositive);
    if (loop.has("response")) result.response = not_zero(loop, "response");
    return result;
  }

  GaitLoop gait(Section& loop) {
    GaitLoop result{.cycle = positive(loop, "cycle"), .actuators = {}};
    const std::size_t actuators = count(loop, "actuators");
    for (std::size_t i = 0; i < actuators; ++i) {
      Section item = loop.item("actuators", i);
      GaitSwing swing{.actuator = element(item, "actuator"),
                      .amplitude = item.number("amplitude", 0.0),
                      .input = {},
                      .gain = 1.0,
                      .phase = item.number("phase", 0.0)};
      if (item.has("input")) {
        swing.input = input_name(item, "input");
        swing.gain = not_zero(item, "gain");
      } else {
        item.require("amplitude", "a number, or an `input` that the amplitude depends on");
        if (item.tree("gain") != nullptr) item.note("gain", "an `input` beside it");
      }
      item.refuse_unread();
      result.actuators.push_back(std::move(swing));
    }
    if (actuators == 0) loop.note("actuators", "a list of at least one actuator");
    return result;
  }

  void read_goal(Section& loop, FeedbackLoop& result) {
    loop.require("goal", "a mapping with `input`, `parameter` or `gain`");
    Section goal = loop.section("goal");
    if (goal.present() && goal.has("input")) {
      result.input = input_name(goal, "input");
      result.goal.gain = not_zero(goal, "gain");
    } else if (goal.present()) {
      result.goal = constant(goal);
    }
    goal.refuse_unread();
  }

  void read_timing() {
    Section limits = section_.section("rate_limit");
    for (const std::string& actuator : limits.keys()) {
      mapping_.rate_limits[actuator] = limits.number(actuator, 1.0, kPositive);
    }
    mapping_.input_delay = section_.number("input_delay", mapping_.input_delay, kInputDelayRange);
    mapping_.settling = section_.number("settling", mapping_.settling, kSettlingRange);
    if (const auto range = section_.vector("time_steps", 2)) {
      mapping_.time_steps = {.least = (*range)[0], .most = (*range)[1]};
      if (!((*range)[0] > 0.0 && (*range)[0] <= (*range)[1])) {
        section_.note("time_steps", "[least, most], 0 < least <= most");
      }
    }
  }

  void require_inputs() {
    for (const std::string& name : coordinate_names(system_.description.inputs)) {
      if (used_.contains(name)) continue;
      section_.note("input", fmt::format("what the input {} does: a list of actuators, each with "
                                         "gain and offset",
                                         name));
    }
  }

  Section& section_;
  const MappedSystem& system_;
  PlantMapping mapping_;
  std::set<std::string> used_;  // inputs that act on something
};

}  // namespace

const std::vector<std::string>& joint_quantities() {
  static const std::vector<std::string> names{"position", "velocity"};
  return names;
}

const std::vector<std::string>& body_quantities() {
  static const std::vector<std::string> names{
      "x",       "y",          "z",          "roll",          "pitch",
      "yaw",     "velocity_x", "velocity_y", "forward_speed", "lateral_speed",
      "yaw_rate"};
  return names;
}

const std::vector<std::string>& velocity_quantities() {
  static const std::vector<std::string> names{"velocity",      "velocity_x",    "velocity_y",
                                              "forward_speed", "lateral_speed", "yaw_rate"};
  return names;
}

std::optional<PlantMapping> read_plant_mapping(Section& plant, const MappedSystem& system) {
  const std::vector<KeyDescription>& keys = plant_mapping_keys();
  const bool any =
      std::ranges::any_of(keys, [&](const KeyDescription& key) { return plant.has(key.name); });
  if (!any) {
    for (const KeyDescription& key : keys)
      (void)plant.holds_text(key.name);  // registers an absent key
    return std::nullopt;
  }
  return MappingReader(plant, system).read();
}

PlantMapping parse_plant_mapping(const std::string& text, const std::string& file,
                                 const MappedSystem& system) {
  const YamlNode tree = parse_yaml(text, file);
  Problems problems(file);
  Section section(tree, problems);
  PlantMapping mapping = MappingReader(section, system).read();
  section.refuse_unread();
  if (!problems.empty()) {
    InputError::Where where = problems.sorted().front();
    where.line = 0;  // relative to the text, not to the file
    throw InputError(where);
  }
  return mapping;
}

PlantMapping own_plant_mapping(const std::optional<std::string>& text, const std::string& file,
                               const MappedSystem& system) {
  if (text) return parse_plant_mapping(*text, file, system);
  throw InputError({.file = file,
                    .key = "plant.state",
                    .found = "nothing",
                    .expected = "where the model has each state and input, in the scenario or in a "
                                "custom text named \"qsmpc\" in the model"});
}

}  // namespace qsmpc::harness
