// The keys of the system, built in or user-defined.
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/own_model_reader.hpp"
#include "harness/scenario/yaml_text.hpp"

namespace qsmpc::harness {
namespace {

// make_dynamics, with its exception, if any, as text.
std::unique_ptr<const models::Dynamics> try_dynamics(const Scenario::Model& model, double time_step,
                                                     std::string& refusal) {
  try {
    return models::make_dynamics(model.system, model.parameters, time_step);
  } catch (const std::invalid_argument& error) {
    refusal = error.what();
    return nullptr;
  }
}

// Attributes an error to the parameter that causes it, by trying each alone among the defaults.
void read_parameters(ScenarioReading& reading, Section& section, const models::SystemEntry& entry) {
  const double time_step = reading.scenario.time_step;
  Scenario::Model& model = reading.scenario.model;
  std::string refusal;
  model.parameters = entry.defaults;
  for (const auto& [name, fallback] : entry.defaults) {
    const double value = section.number(name, fallback);
    Scenario::Model alone{.system = entry.name, .parameters = entry.defaults};
    alone.parameters[name] = value;
    if (value == fallback || try_dynamics(alone, time_step, refusal) != nullptr) {
      model.parameters[name] = value;
    } else {
      section.note(name, "a value that the system accepts: " + refusal);
    }
  }
  reading.dynamics = try_dynamics(model, time_step, refusal);
  if (reading.dynamics == nullptr) {
    section.note_here("values that the system accepts: " + refusal, "incompatible parameters");
    model.parameters = entry.defaults;
    reading.dynamics = try_dynamics(model, time_step, refusal);
  }
}

void read_system(ScenarioReading& reading, Section& section) {
  for (const models::SystemEntry& entry : models::systems()) {
    if (entry.name != reading.scenario.model.system) continue;
    read_parameters(reading, section, entry);
    return;
  }
  for (const std::string& key : section.keys()) (void)section.holds_text(key);  // system not known
}

void read_model(ScenarioReading& reading, Section& root, const KeyDescription& about) {
  Section section = root.section(about.name);
  if (is_own_model(section)) return read_own_model(reading, section);
  const std::string expected =
      expected_names("", system_names()) + "; or equations or a library of your own";
  section.require("system", expected);
  std::string& system = reading.scenario.model.system;
  system = section.name("system", system, system_names());
  read_system(reading, section);
  section.refuse_unread();
}

/// Without derivatives, no certificate can keep a risk limit.
void check_derivatives(const ScenarioReading& reading, Section& root) {
  const Scenario::Model& model = reading.scenario.model;
  if (!model.own || model.own->differentiable || !reading.scenario.risk.any()) return;
  root.note("risk",
            "no limits: the system " + model.system +
                " provides no derivatives, so no certificate is given",
            "risk limits");
}

std::optional<std::string> model_text(const Scenario& scenario,
                                      const models::SystemDescription& /*system*/) {
  const Scenario::Model& model = scenario.model;
  if (model.own) return own_model_text(model);
  std::string out = "system: " + model.system;
  for (const auto& [name, value] : model.parameters) {
    out += fmt::format(", {}: {}", name, yaml_number(value));
  }
  return "{" + out + "}";
}

}  // namespace

ScenarioKey model_key() {
  ScenarioKey key{.about = {.name = "model", .required = true},
                  .read = read_model,
                  .check = check_derivatives,
                  .write = model_text,
                  .after = ReadAfter::kTimeStep,
                  .table = "plant"};
  key.keys = {{.about = {.name = "system",
                         .values = {TextValue{.longest = kLongestName, .what = "a name"}},
                         .words = "a name from `qsmpc list systems`; with `library`, one of its "
                                  "systems; with `equations`, the name of yours",
                         .fallback_words = "required without `library` and `equations`"},
               .member = [](Scenario& scenario) -> std::string& { return scenario.model.system; }},
              {.about = {.name = "PARAMETER",
                         .family = NameFamily::kParameters,
                         .values = {NumberValue{}},
                         .words = "a constant of the system",
                         .see = "[systems](#systems)",
                         .unit = "of the constant",
                         .fallback_words = "the system's"},
               .read = [](ScenarioReading& /*reading*/, Section& /*section*/,
                          const KeyDescription& /*about*/) {}}};
  for (KeyDescription& own : own_model_keys()) key.keys.push_back({.about = std::move(own)});
  return key;
}

}  // namespace qsmpc::harness
