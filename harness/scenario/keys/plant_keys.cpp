// The keys of the plant.
#include <utility>

#include <fmt/format.h>

#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/model_error_reader.hpp"
#include "harness/scenario/plant_choice.hpp"
#include "harness/scenario/plant_mapping_keys.hpp"
#include "harness/scenario/plant_mapping_reader.hpp"
#include "harness/scenario/shipped_files.hpp"
#include "harness/scenario/yaml_text.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kShortestSimulatorStep = 1e-6;  // s

// The default vehicle of a system, which drives or is drawn. A vehicle without a position in the
// plane cannot be drawn without its own simulation.
std::string default_mjcf(const models::SystemDescription& system, const std::string& kind) {
  return kind != "mujoco" && system.position_x < 0 ? "" : default_vehicle(system.name);
}

void read_mjcf(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  Scenario::Plant& plant = reading.scenario.plant;
  const bool knows_system = reading.dynamics != nullptr;
  const std::string fallback = knows_system ? default_mjcf(reading.system(), plant.kind) : "";
  const std::string name = section.text(about.name, fallback, value_of<TextValue>(about).longest);
  const bool is_needed = plant.kind == "mujoco" && knows_system;
  std::string path = find_mjcf(name, reading.lookup.folder);
  if (path.empty() && section.is_override(about.name)) path = find_mjcf(name, "");
  plant.mjcf = path.empty() && !reading.lookup.must_exist ? name : path;
  if (name.empty() && is_needed) {
    section.note(about.name, "a MuJoCo XML file, because the plant's kind is mujoco");
  } else if (plant.mjcf.empty() && (is_needed || section.has(about.name)) && !name.empty()) {
    section.note(about.name,
                 "a file beside the scenario, or " + expected_names(name, shipped_mjcf_names()),
                 "no file " + name);
  }
}

void read_plant_time_step(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  NumberRange range = value_of<NumberValue>(about).range;
  range.most = reading.scenario.time_step;
  const double value = section.number(about.name, range.least, range);
  if (section.has(about.name)) reading.scenario.plant.time_step = value;
}

void read_mapping(ScenarioReading& reading, Section& section, const KeyDescription& /*about*/) {
  if (reading.dynamics == nullptr) return;
  reading.scenario.plant.mapping = read_plant_mapping(
      section, {.description = reading.system(), .parameters = reading.scenario.model.parameters});
}

ScenarioKey mjcf_key() {
  return {
      .about = {.name = "mjcf",
                .values = {TextValue{}},
                .words =
                    "MuJoCo XML file: an absolute path, a path relative to the scenario's folder, "
                    "or a shipped name, searched in this order; with `--set`, finally relative to "
                    "the working folder. For an analytic plant it is only drawn, and may be `\"\"`",
                .fallback_words = "the wheeled vehicle of the system, or the only one, see "
                                  "[plants](plants.md); none for an analytic plant without a place "
                                  "in the plane"},
      .read = read_mjcf,
      .write = [](const Scenario& scenario, const models::SystemDescription& /*system*/) {
        return std::optional(quoted_yaml(mjcf_name(scenario.plant.mjcf)));
      }};
}

ScenarioKey plant_time_step_key() {
  return {.about = {.name = "time_step",
                    .values = {NumberValue{{.least = kShortestSimulatorStep}}},
                    .words = "time step of the simulator, {range} and at most `time_step`, of "
                             "which it must be a divisor",
                    .unit = "s",
                    .fallback_words = "the XML file's"},
          .read = read_plant_time_step,
          .write = [](const Scenario& scenario,
                      const models::SystemDescription& /*system*/) -> std::optional<std::string> {
            if (!scenario.plant.time_step) return std::nullopt;
            return yaml_number(*scenario.plant.time_step);
          }};
}

ScenarioKey solid_key() {
  return {.about = {.name = "solid",
                    .values = {FlagValue{}},
                    .words = "whether the bounds of the position and the obstacles are solid for "
                             "the MuJoCo vehicle, with its contacts recorded",
                    .see = "[plants](plants.md#solid-walls-and-obstacles)"},
          .member = [](Scenario& scenario) -> bool& { return scenario.plant.solid; },
          .check =
              [](const ScenarioReading& reading, Section& section) {
                if (!reading.scenario.plant.solid) return;
                const models::SystemDescription& system = reading.system();
                if (reading.scenario.plant.kind == "analytic") {
                  section.note("solid", "false, or plant.kind: mujoco");
                } else if (system.position_x < 0 || system.position_y < 0) {
                  section.note("solid", "false, because the system has no position in the plane");
                }
              }};
}

ScenarioKey mapping_key() {
  return {.about = {.values = {MappingValue{plant_mapping_keys()}},
                    .words = "how the system appears in the MuJoCo model",
                    .see = "[plants](plants.md#mapping)",
                    .fallback_words = "the mapping in the XML file"},
          .read = read_mapping,
          .write = [](const Scenario& scenario,
                      const models::SystemDescription& /*system*/) -> std::optional<std::string> {
            if (!scenario.plant.mapping) return std::nullopt;
            return plant_mapping_text(*scenario.plant.mapping);
          }};
}

}  // namespace

ScenarioKey plant_key() {
  return {
      .about = {.name = "plant"},
      .keys = {{.about = {.name = "kind",
                          .values = {NameValue{plant_kind_names()}},
                          .words = "`mujoco`, or `analytic`: the planner's own model"},
                .member = [](Scenario& scenario) -> std::string& { return scenario.plant.kind; }},
               mjcf_key(),
               plant_time_step_key(),
               solid_key(),
               mapping_key()},
      .layout = SectionLayout::kFlow,
      .after = ReadAfter::kTimeStep,
      .table = "plant"};
}

ScenarioKey model_error_key() {
  return {.about = {.name = "model_error",
                    .values = {TextValue{}, MappingValue{model_error_keys()}},
                    .words = "how far the plant is from the model: a mapping of the keys below, or "
                             "the path of a YAML file with them, absolute or relative to the "
                             "scenario's folder (with `--set`, otherwise to the working folder)",
                    .see = "[below](#a-plant-that-is-not-the-model)",
                    .fallback_words = "none: certificates apply to the model"},
          .read =
              [](ScenarioReading& reading, Section& section, const KeyDescription& /*about*/) {
                std::optional<StatedModelError> stated =
                    read_model_error(section, reading.problems,
                                     {.system = reading.scenario.model.system,
                                      .dim = std::ssize(reading.system().states),
                                      .folder = reading.lookup.folder,
                                      .parameters = reading.scenario.model.parameters,
                                      .time_step = reading.scenario.time_step});
                if (!stated) return;
                reading.scenario.model_error = std::move(stated->error);
                reading.scenario.error_origin = std::move(stated->origin);
              },
          .write = [](const Scenario& scenario,
                      const models::SystemDescription& /*system*/) -> std::optional<std::string> {
            if (!scenario.model_error) return std::nullopt;
            std::string text =
                "\n" + model_error_text({*scenario.model_error, scenario.error_origin}, "  ");
            text.pop_back();  // the final line feed
            return text;
          },
          .after = ReadAfter::kSystem,
          .table = "plant"};
}

}  // namespace qsmpc::harness
