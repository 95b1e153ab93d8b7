#include "harness/scenario/error_origin.hpp"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/mujoco/mujoco_model.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/yaml_text.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kOriginKey = "measured";
constexpr const char* kUnknown = "unknown";
constexpr std::size_t kLongestDigest = 64;  // bytes
// Relative tolerance for constants that were written with all their digits.
constexpr double kOriginRounding = 1e-12;

bool is_same(double one, double other) {
  return std::abs(one - other) <= kOriginRounding * std::abs(other);
}

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

std::optional<double> number_if_there(Section& section, const std::string& key, NumberRange range) {
  const bool has = section.has(key);
  const double value = section.number(key, 0.0, range);
  return has ? std::optional(value) : std::nullopt;
}

void read_model(Section& section, const ModelErrorContext& context, Scenario::ErrorOrigin& origin) {
  Section parameters = section.section("parameters");
  for (const auto& [name, value] : context.parameters) {
    if (!parameters.has(name)) {
      (void)parameters.number(name, value);  // a known key
      continue;
    }
    origin.parameters[name] = parameters.number(name, value);
    if (!is_same(origin.parameters[name], value)) {
      parameters.note(
          name,
          fmt::format("{}, the model's value: the error was measured with another one", value));
    }
  }
  parameters.refuse_unread();
  origin.time_step = number_if_there(section, "time_step", kPositive);
  if (origin.time_step && context.time_step > 0.0 &&
      !is_same(*origin.time_step, context.time_step)) {
    section.note(
        "time_step",
        fmt::format("{}, the scenario's value: the error was measured with another control period",
                    context.time_step));
  }
}

void read_plant(Section& section, Scenario::ErrorOrigin& origin) {
  Section plant = section.section("plant");
  origin.plant.kind = plant.name("kind", "", plant_kind_names());
  origin.plant.mjcf = plant.text("mjcf", "", kLongestPath);
  origin.digest = plant.text("digest", "", kLongestDigest);
  origin.plant.time_step = number_if_there(plant, "time_step", kPositive);
  origin.plant.solid = plant.flag("solid", false);
  plant.refuse_unread();
  Section disturbance = section.section("disturbance");
  origin.disturbance_kind = disturbance.name("kind", "", disturbance_kind_names());
  origin.friction = number_if_there(disturbance, "friction", kNotNegative);
  origin.mass = number_if_there(disturbance, "mass", kNotNegative);
  origin.wheelbase = number_if_there(disturbance, "wheelbase", kNotNegative);
  disturbance.refuse_unread();
}

KeyDescription deviation(const char* name) {
  return {.name = name,
          .values = {NumberValue{kNotNegative}},
          .words = "its deviation, as in `disturbance`, {range}",
          .fallback_words = kUnknown};
}

KeyDescription plant_part() {
  return {.name = "plant",
          .values = {MappingValue{{{.name = "kind",
                                    .values = {NameValue{plant_kind_names()}},
                                    .words = "`analytic` or `mujoco`; a difference from the "
                                             "scenario's plant causes a warning, here and below",
                                    .fallback_words = kUnknown},
                                   {.name = "mjcf",
                                    .values = {TextValue{}},
                                    .words = "name of its MuJoCo file",
                                    .fallback_words = kUnknown},
                                   {.name = "digest",
                                    .values = {TextValue{.longest = kLongestDigest}},
                                    .words = "digest of the model that this file compiles to",
                                    .fallback_words = kUnknown},
                                   {.name = "time_step",
                                    .values = {NumberValue{kPositive}},
                                    .words = "the simulator's time step, if the scenario sets it",
                                    .unit = "s",
                                    .fallback_words = "the file's"},
                                   {.name = "solid",
                                    .values = {FlagValue{}},
                                    .words = "whether walls and obstacles were solid",
                                    .fallback = "false"}}}}};
}

KeyDescription disturbance_part() {
  return {.name = "disturbance",
          .values = {MappingValue{{{.name = "kind",
                                    .values = {NameValue{disturbance_kind_names()}},
                                    .words = "how the noise acted on it: `state` or `force`",
                                    .fallback_words = kUnknown},
                                   deviation("friction"),
                                   deviation("mass"),
                                   deviation("wheelbase")}}}};
}

/// One line for a difference between the two.
void compare(std::vector<std::string>& differences, const char* what, const std::string& there,
             const std::string& here) {
  if (there.empty() || there == here) return;
  differences.push_back(
      fmt::format("{}: {} there, {} here", what, there, here.empty() ? "none" : here));
}

void compare(std::vector<std::string>& differences, const char* what, std::optional<double> there,
             double here) {
  if (!there || is_same(*there, here)) return;
  compare(differences, what, fmt::format("{}", *there), fmt::format("{}", here));
}

std::string step_words(const std::optional<double>& step) {
  return step ? fmt::format("{} s", *step) : "the file's";
}

}  // namespace

KeyDescription error_origin_key() {
  return {
      .name = kOriginKey,
      .values = {MappingValue{
          {{.name = "parameters",
            .values = {MappingValue{
                {{.name = "PARAMETER",
                  .family = NameFamily::kParameters,
                  .values = {NumberValue{}},
                  .words =
                      "a constant of the system that it was measured for; another value is refused",
                  .unit = "of the constant",
                  .fallback_words = kUnknown}}}}},
           {.name = "time_step",
            .values = {NumberValue{kPositive}},
            .words = "the control period, {range}; another one is refused",
            .unit = "s",
            .fallback_words = kUnknown},
           plant_part(),
           disturbance_part()}}}};
}

std::optional<Scenario::ErrorOrigin> read_error_origin(Section& section,
                                                       const ModelErrorContext& context) {
  Section measured = section.section(kOriginKey);
  if (!measured.present()) return std::nullopt;
  Scenario::ErrorOrigin origin;
  read_model(measured, context, origin);
  read_plant(measured, origin);
  measured.refuse_unread();
  return origin;
}

std::string error_origin_text(const Scenario::ErrorOrigin& origin, const std::string& indent) {
  std::vector<std::string> parts;
  const auto part = [&parts](const std::string& key, const std::string& value) {
    if (!value.empty()) parts.push_back(key + ": " + value);
  };
  const auto number = [&part](const std::string& key, const std::optional<double>& value) {
    if (value) part(key, yaml_number(*value));
  };
  std::string text;
  const auto line = [&](const std::string& key) {
    if (!parts.empty()) {
      text += fmt::format("{}  {}: {{{}}}\n", indent, key, fmt::join(parts, ", "));
    }
    parts.clear();
  };
  for (const auto& [name, value] : origin.parameters) part(name, yaml_number(value));
  line("parameters");
  if (origin.time_step) {
    text += fmt::format("{}  time_step: {}\n", indent, yaml_number(*origin.time_step));
  }
  part("kind", origin.plant.kind);
  if (!origin.plant.mjcf.empty()) part("mjcf", quoted_yaml(origin.plant.mjcf));
  if (!origin.digest.empty()) part("digest", quoted_yaml(origin.digest));
  number("time_step", origin.plant.time_step);
  if (origin.plant.solid) part("solid", "true");
  line("plant");
  part("kind", origin.disturbance_kind);
  number("friction", origin.friction);
  number("mass", origin.mass);
  number("wheelbase", origin.wheelbase);
  line("disturbance");
  return text.empty() ? text : indent + kOriginKey + ":\n" + text;
}

Scenario::ErrorOrigin error_origin_of(const Scenario& scenario) {
  const bool simulated = scenario.plant.kind == "mujoco";
  return {.parameters = scenario.model.parameters,
          .time_step = scenario.time_step,
          .plant = {.kind = scenario.plant.kind,
                    .mjcf = simulated ? file_name(scenario.plant.mjcf) : "",
                    .time_step = scenario.plant.time_step,
                    .solid = scenario.plant.solid},
          .digest = simulated ? mujoco_model_digest(scenario.plant.mjcf) : "",
          .disturbance_kind = scenario.disturbance.kind,
          .friction = scenario.disturbance.friction,
          .mass = scenario.disturbance.mass,
          .wheelbase = scenario.disturbance.wheelbase};
}

std::vector<std::string> plant_differences(const Scenario& scenario) {
  std::vector<std::string> differences;
  if (!scenario.error_origin || scenario.error_origin->plant.kind.empty()) return differences;
  const Scenario::ErrorOrigin& there = *scenario.error_origin;
  const Scenario::ErrorOrigin here = error_origin_of(scenario);
  compare(differences, "plant.kind", there.plant.kind, here.plant.kind);
  compare(differences, "plant.mjcf", there.plant.mjcf, here.plant.mjcf);
  if (differences.empty() && !there.digest.empty() && there.digest != here.digest) {
    differences.push_back(fmt::format("plant.mjcf: {} has changed since", here.plant.mjcf));
  }
  compare(differences, "plant.time_step", step_words(there.plant.time_step),
          step_words(here.plant.time_step));
  compare(differences, "plant.solid", there.plant.solid ? "true" : "false",
          here.plant.solid ? "true" : "false");
  compare(differences, "disturbance.kind", there.disturbance_kind, here.disturbance_kind);
  compare(differences, "disturbance.friction", there.friction, *here.friction);
  compare(differences, "disturbance.mass", there.mass, *here.mass);
  compare(differences, "disturbance.wheelbase", there.wheelbase, *here.wheelbase);
  return differences;
}

}  // namespace qsmpc::harness
