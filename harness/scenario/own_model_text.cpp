// own_model_text and own_model_keys: how a user-defined system is written and described.
#include <fmt/format.h>

#include "harness/scenario/own_model_reader.hpp"
#include "harness/scenario/yaml_text.hpp"

namespace qsmpc::harness {
namespace {

using models::EquationSystem;

constexpr std::size_t kLongestFormula = 10000;  // bytes

/// {a: …, b: …} from complete items.
std::string braces(const std::string& items) { return "{" + items + "}"; }

void add(std::string& items, const std::string& item) {
  items += (items.empty() ? "" : ", ") + item;
}

std::string states_text(const std::vector<models::Coordinate>& states) {
  std::string items;
  for (const models::Coordinate& state : states) {
    const std::string unit = quoted_yaml(state.unit);
    add(items, state.is_angle ? fmt::format("{}: {{unit: {}, angle: true}}", state.name, unit)
                              : fmt::format("{}: {}", state.name, unit));
  }
  return braces(items);
}

std::string inputs_text(const EquationSystem& system) {
  std::string items;
  for (std::size_t i = 0; i < system.inputs.size(); ++i) {
    const models::Coordinate& input = system.inputs[i];
    const auto at = static_cast<Eigen::Index>(i);
    add(items,
        fmt::format("{}: {{unit: {}, {}bounds: [{}, {}]}}", input.name, quoted_yaml(input.unit),
                    input.is_angle ? "angle: true, " : "", yaml_number(system.input_lower[at]),
                    yaml_number(system.input_upper[at])));
  }
  return braces(items);
}

std::string parameters_text(const Scenario::Model& model) {
  std::string items;
  for (const auto& parameter : model.own->parameters) {
    const std::string value = yaml_number(model.parameters.at(parameter.name));
    add(items, parameter.unit.empty() ? fmt::format("{}: {}", parameter.name, value)
                                      : fmt::format("{}: {{value: {}, unit: {}}}", parameter.name,
                                                    value, quoted_yaml(parameter.unit)));
  }
  return braces(items);
}

std::string formulas_text(const char* key, const std::vector<EquationSystem::Formula>& formulas) {
  if (formulas.empty()) return "";
  std::string text = fmt::format("\n  {}:", key);
  for (const auto& [name, formula] : formulas) {
    text += fmt::format("\n    {}: {}", name, quoted_yaml(formula));
  }
  return text;
}

std::string plane_text(const EquationSystem& system) {
  const auto name = [&](int state) { return system.states[static_cast<std::size_t>(state)].name; };
  std::string text;
  if (system.position_x >= 0 && system.position_y >= 0) {
    text += fmt::format("\n  position: [{}, {}]", name(system.position_x), name(system.position_y));
  }
  if (system.heading >= 0) text += "\n  heading: " + name(system.heading);
  return text;
}

std::string time_text(const EquationSystem& system) {
  if (system.time == EquationSystem::Time::kDiscrete) return "";
  const bool is_euler = system.time == EquationSystem::Time::kEuler;
  return fmt::format("\n  time: continuous\n  integrator: {}\n  substeps: {}",
                     is_euler ? "euler" : "rk4", system.substeps);
}

KeyDescription coordinate_key(const char* name, bool is_input) {
  MappingValue parts{{{.name = "unit",
                       .values = {TextValue{.longest = kLongestName}},
                       .words = "its SI symbol",
                       .fallback_words = "none"},
                      {.name = "angle",
                       .values = {FlagValue{}},
                       .words = "whether values 2π apart are equivalent",
                       .fallback = "false"}}};
  if (is_input) {
    parts.keys.push_back({.name = "bounds",
                          .values = {IntervalValue{.finite = true}},
                          .words = "`[lower, upper]`, its bounds",
                          .unit = "of the input",
                          .required = true});
    return {.name = name, .family = NameFamily::kFree, .values = {std::move(parts)}};
  }
  return {.name = name,
          .family = NameFamily::kFree,
          .values = {TextValue{.longest = kLongestName}, std::move(parts)}};
}

KeyDescription of_names(const char* name, KeyDescription item, std::string words) {
  return {.name = name,
          .values = {MappingValue{{std::move(item)}}},
          .words = std::move(words),
          .see = "[own dynamics](dynamics.md)",
          .fallback_words = "none"};
}

KeyDescription formula_key(const char* name) {
  return {.name = name,
          .family = NameFamily::kFree,
          .values = {TextValue{.longest = kLongestFormula, .what = "a formula"}}};
}

KeyDescription parameter_key() {
  return {
      .name = "NAME",
      .family = NameFamily::kFree,
      .values = {
          NumberValue{},
          MappingValue{
              {{.name = "value", .values = {NumberValue{}}, .words = "its value", .required = true},
               {.name = "unit",
                .values = {TextValue{.longest = kLongestName}},
                .words = "its SI symbol",
                .fallback_words = "none"}}}}};
}

std::vector<KeyDescription> integration_keys() {
  return {{.name = "time",
           .values = {NameValue{{"discrete", "continuous"}}},
           .words = "whether an equation gives the state after a control period (`discrete`) or "
                    "its time derivative (`continuous`)",
           .fallback = "discrete"},
          {.name = "integrator",
           .values = {NameValue{{"euler", "rk4"}}},
           .words = "for continuous equations: `euler`, or `rk4`, the classical Runge-Kutta method",
           .fallback = "rk4"},
          {.name = "substeps",
           .values = {WholeValue{1, models::kMostSubsteps}},
           .words = "its steps per control period",
           .fallback = "1"}};
}

}  // namespace

std::string own_model_text(const Scenario::Model& model) {
  const EquationSystem& system = *model.own;
  std::string text;
  if (!model.library.empty()) text += "\n  library: " + quoted_yaml(model.library);
  text += "\n  system: " + quoted_yaml(system.name);
  text += "\n  states: " + states_text(system.states);
  text += "\n  inputs: " + inputs_text(system);
  if (!system.parameters.empty()) text += "\n  parameters: " + parameters_text(model);
  text += formulas_text("define", system.definitions);
  text += formulas_text("equations", system.equations);
  text += time_text(system) + plane_text(system);
  if (!system.differentiable) text += "\n  derivatives: false";
  return text;
}

std::vector<KeyDescription> own_model_keys() {
  std::vector<KeyDescription> keys = {
      {.name = "library",
       .values = {TextValue{.what = "a shared library"}},
       .words = "shared library that contains the system, relative to the scenario's folder: its "
                "code is executed",
       .see = "[own dynamics](dynamics.md#in-c)",
       .fallback_words = "none"},
      of_names("states", coordinate_key("STATE", false),
               "the states of a system of your own: the unit of each, or `{unit: …, angle: true}`"),
      of_names("inputs", coordinate_key("INPUT", true),
               "its inputs: `{unit: …, bounds: [lower, upper]}` each"),
      of_names("parameters", parameter_key(),
               "constants of a system of your own: a number each, or `{value: …, unit: …}`"),
      of_names("define", formula_key("NAME"), "auxiliary formulas, which may use each other"),
      of_names("equations", formula_key("STATE"),
               "a formula for each state in terms of states, inputs, parameters, definitions, "
               "`time_step` and `pi`")};
  for (KeyDescription& key : integration_keys()) keys.push_back(std::move(key));
  keys.push_back({.name = "position",
                  .values = {list_of_values(TextValue{.longest = kLongestName}, {2, 2})},
                  .words = "two states: the position in the plane, required by maps, obstacle "
                           "shapes and footprints",
                  .fallback_words = "none"});
  keys.push_back({.name = "heading",
                  .values = {TextValue{.longest = kLongestName}},
                  .words = "a state: the heading, from x to y",
                  .fallback_words = "none"});
  keys.push_back({.name = "derivatives",
                  .values = {FlagValue{}},
                  .words = "in resolved scenarios: `false` if a library provides no derivatives",
                  .fallback = "true"});
  return keys;
}

}  // namespace qsmpc::harness
