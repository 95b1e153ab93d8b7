// The keys of the controllers with a chance constraint from the literature, and of the shield.
#include <algorithm>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "controller/chance/chance_constraint.hpp"
#include "controller/control/controller.hpp"
#include "harness/scenario/keys/effect_checks.hpp"
#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/value_checks.hpp"

namespace qsmpc::harness {
namespace {

constexpr NumberRange kRiskRange{.least = 0.0, .most = 0.5, .above_least = true};
constexpr NumberRange kConfidenceRange{.least = 0.0, .most = 0.999999, .above_least = true};
constexpr NumberRange kLimitRange{.least = 0.0, .most = 1.0, .above_least = true};
constexpr NumberRange kRadiusRange{.least = 0.0, .most = 1e6};
constexpr NumberRange kRoundingRange{.least = 0.0, .most = 1e6, .above_least = true};
constexpr WholeValue kPathsRange{0, 100'000};
constexpr WholeValue kMemoryRange{1, kMostStages};

bool keeps_chance_constraint(const Scenario& scenario) {
  const std::string& kind = driving_kind(scenario.controller);
  if (kind == "tube") return true;
  const auto& known = controller::chance_constraints();
  return std::any_of(known.begin(), known.end(),
                     [&](const auto& entry) { return entry.name == kind; });
}

/// Whether the controller samples paths, so that inputs can respond to their noise.
bool samples_paths(const Scenario& scenario) {
  const auto& known = controller::chance_constraints();
  return std::any_of(known.begin(), known.end(), [&](const auto& entry) {
    return entry.name == driving_kind(scenario.controller) && entry.samples;
  });
}

controller::ChanceSettings& chance_of(Scenario& scenario) { return scenario.controller.chance; }

/// Whether the controller is one of these.
bool is_one_of(const ScenarioReading& reading, std::initializer_list<const char*> kinds) {
  return std::any_of(kinds.begin(), kinds.end(), [&](const char* kind) {
    return driving_kind(reading.scenario.controller) == kind;
  });
}

template <auto kMember>
void check_chance(const ScenarioReading& reading, Section& section, const char* key,
                  bool has_effect, const char* condition) {
  check_has_effect(section, key, reading.scenario.controller.chance.*kMember,
                   controller::ChanceSettings{}.*kMember, has_effect, condition);
}

template <auto kMember>
void check_shield(const ScenarioReading& reading, Section& section, const char* key) {
  check_has_effect(section, key, reading.scenario.controller.shield.*kMember,
                   Scenario::Controller{}.shield.*kMember,
                   reading.scenario.controller.kind == "shield", "controller.kind: shield");
}

void check_chance_risk(const ScenarioReading& reading, Section& section) {
  check_chance<&controller::ChanceSettings::risk>(
      reading, section, "risk", keeps_chance_constraint(reading.scenario),
      "a controller.kind that keeps a chance constraint");
}

void check_paths(const ScenarioReading& reading, Section& section) {
  check_chance<&controller::ChanceSettings::paths>(reading, section, "paths",
                                                   samples_paths(reading.scenario),
                                                   "controller.kind: scenario, cvar or drcc");
}

void check_confidence(const ScenarioReading& reading, Section& section) {
  check_chance<&controller::ChanceSettings::confidence>(reading, section, "confidence",
                                                        is_one_of(reading, {"scenario"}),
                                                        "controller.kind: scenario");
}

void check_radius(const ScenarioReading& reading, Section& section) {
  check_chance<&controller::ChanceSettings::radius>(
      reading, section, "radius", is_one_of(reading, {"drcc"}), "controller.kind: drcc");
}

void check_smoothing(const ScenarioReading& reading, Section& section) {
  check_chance<&controller::ChanceSettings::smoothing>(reading, section, "smoothing",
                                                       is_one_of(reading, {"cvar", "drcc"}),
                                                       "controller.kind: cvar or drcc");
}

void check_memory(const ScenarioReading& reading, Section& section) {
  const Scenario::Controller& settings = reading.scenario.controller;
  check_has_effect(
      section, "memory", settings.disturbance_memory, Scenario::Controller{}.disturbance_memory,
      settings.policy == "disturbance_feedback", "controller.policy: disturbance_feedback");
}

}  // namespace

void check_policy(const ScenarioReading& reading, Section& section) {
  if (reading.scenario.controller.policy != "disturbance_feedback") return;
  if (samples_paths(reading.scenario)) return;
  section.note("policy",
               "closed_loop or open_loop, or controller.kind: scenario, cvar or drcc, whose paths "
               "contain noise that inputs can respond to");
}

ScenarioKey chance_key() {
  return {
      .about = {.name = "chance"},
      .is_written = keeps_chance_constraint,
      .keys =
          {{.about = {.name = "risk",
                      .values = {NumberValue{kRiskRange}},
                      .words = "permitted probability, as the method estimates it, that a stage of "
                               "a plan is unsafe; with `scenario`, that any stage is"},
            .member = [](Scenario& scenario) -> double& { return chance_of(scenario).risk; },
            .check = check_chance_risk},
           {.about = {.name = "paths",
                      .values = {kPathsRange},
                      .words = "number of paths sampled for a plan, {range}; 0: as many as the "
                               "sample bound requires with `scenario`, 200 with `cvar` and `drcc`"},
            .member = [](Scenario& scenario) -> int& { return chance_of(scenario).paths; },
            .check = check_paths},
           {.about = {.name = "confidence",
                      .values = {NumberValue{kConfidenceRange}},
                      .words = "for `scenario`: confidence of the sample bound"},
            .member = [](Scenario& scenario) -> double& { return chance_of(scenario).confidence; },
            .check = check_confidence},
           {.about = {.name = "radius",
                      .values = {NumberValue{kRadiusRange}},
                      .words = "for `drcc`: radius of the ball of laws about the sampled one, in "
                               "the 1-Wasserstein distance",
                      .unit = "m"},
            .member = [](Scenario& scenario) -> double& { return chance_of(scenario).radius; },
            .check = check_radius},
           {.about = {.name = "smoothing",
                      .values = {NumberValue{kRoundingRange}},
                      .words = "for `cvar` and `drcc`: half-width, in clearance, over which the "
                               "beginning of the tail is smoothed",
                      .unit = "m"},
            .member = [](Scenario& scenario) -> double& { return chance_of(scenario).smoothing; },
            .check = check_smoothing},
           {.about = {.name = "memory",
                      .values = {kMemoryRange},
                      .words = "with `controller.policy: disturbance_feedback`: number of latest "
                               "noise values that an input responds to"},
            .member = [](Scenario& scenario) -> int& {
              return scenario.controller.disturbance_memory;
            },
            .check = check_memory}},
      .layout = SectionLayout::kFlow};
}

ScenarioKey shield_key() {
  return {
      .about = {.name = "shield"},
      .is_written = [](const Scenario& scenario) { return scenario.controller.kind == "shield"; },
      .keys = {{.about = {.name = "of",
                          .values = {NameValue{shielded_names()}},
                          .words = "the controller that drives while it is certified within the "
                                   "limit: {names}"},
                .member = [](Scenario& scenario) -> std::string& {
                  return scenario.controller.shield.of;
                },
                .check =
                    [](const ScenarioReading& reading, Section& section) {
                      check_shield<&Scenario::Shield::of>(reading, section, "of");
                    }},
               {.about = {.name = "limit",
                          .values = {NumberValue{kLimitRange}},
                          .words = "certified probability of being unsafe, at any of the stages "
                                   "looked ahead, above which it is overruled"},
                .member = [](Scenario& scenario) -> double& {
                  return scenario.controller.shield.limit;
                },
                .check =
                    [](const ScenarioReading& reading, Section& section) {
                      check_shield<&Scenario::Shield::limit>(reading, section, "limit");
                    }},
               {.about = {.name = "stages",
                          .values = {WholeValue{0, kMostStages}},
                          .words = "number of stages looked ahead, {range}; 0: the whole horizon"},
                .member = [](Scenario& scenario) -> int& {
                  return scenario.controller.shield.stages;
                },
                .check =
                    [](const ScenarioReading& reading, Section& section) {
                      check_shield<&Scenario::Shield::stages>(reading, section, "stages");
                    }}},
      .layout = SectionLayout::kFlow};
}

}  // namespace qsmpc::harness
