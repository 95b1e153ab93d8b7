// The keys of the sampling controllers, `mppi` and `risk_mppi`.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/scenario/keys/effect_checks.hpp"
#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/yaml_text.hpp"

namespace qsmpc::harness {
namespace {

using controller::MppiSettings;

constexpr const char* kMppi = "mppi";
constexpr const char* kRiskMppi = "risk_mppi";

constexpr WholeValue kSamplesRange{2, 1'000'000};
constexpr WholeValue kUpdatesRange{1, 1000};
constexpr WholeValue kSmoothingRange{0, 1000};
constexpr WholeValue kNoisePathsRange{1, 10'000};
constexpr NumberRange kShareRange{.least = 0.0, .most = 1.0, .above_least = true};
constexpr NumberRange kUnitRange{.least = 0.0, .most = 1.0};
constexpr NumberRange kBelowOneRange{.least = 0.0, .most = 0.999};

template <auto kMember>
void check_is_used(const ScenarioReading& reading, Section& section, const char* key, bool is_used,
                   const char* condition) {
  check_has_effect(section, key, reading.scenario.controller.mppi.*kMember, MppiSettings{}.*kMember,
                   is_used, condition);
}

template <auto kMember>
void check_is_sampling(const ScenarioReading& reading, Section& section, const char* key) {
  check_is_used<kMember>(reading, section, key, is_sampling(reading.scenario.controller),
                         "controller.kind: mppi or risk_mppi");
}

template <auto kMember>
void check_is_of(const ScenarioReading& reading, Section& section, const char* key,
                 const char* kind) {
  check_is_used<kMember>(reading, section, key, driving_kind(reading.scenario.controller) == kind,
                         (std::string("controller.kind: ") + kind).c_str());
}

template <auto kMember>
auto& member_of(Scenario& scenario) {
  return scenario.controller.mppi.*kMember;
}

/// The key of a number whose default the controller chooses.
template <std::optional<double> MppiSettings::*kMember>
ScenarioKey optional_key(const KeyDescription& about) {
  return {.about = about,
          .read =
              [](ScenarioReading& reading, Section& section, const KeyDescription& key) {
                if (!section.has(key.name)) return;
                const NumberRange range = value_of<NumberValue>(key).range;
                reading.scenario.controller.mppi.*kMember = section.number(key.name, 1.0, range);
                if (!is_sampling(reading.scenario.controller)) {
                  section.note(key.name, "nothing, or controller.kind: mppi or risk_mppi");
                }
              },
          .write = [](const Scenario& scenario,
                      const models::SystemDescription&) -> std::optional<std::string> {
            const std::optional<double>& value = scenario.controller.mppi.*kMember;
            return value ? std::optional(yaml_number(*value)) : std::nullopt;
          }};
}

std::vector<ScenarioKey> sample_keys() {
  return {
      {.about = {.name = "samples",
                 .values = {kSamplesRange},
                 .words = "for `mppi` and `risk_mppi`, like all keys of this section: number of "
                          "input sequences drawn and rolled out",
                 .see = "[below](#sampling)"},
       .member = member_of<&MppiSettings::samples>,
       .check =
           [](const ScenarioReading& reading, Section& section) {
             check_is_sampling<&MppiSettings::samples>(reading, section, "samples");
           }},
      {.about = {.name = "iterations",
                 .values = {kUpdatesRange},
                 .words = "updates of the inputs per period, each with new samples"},
       .member = member_of<&MppiSettings::iterations>,
       .check =
           [](const ScenarioReading& reading, Section& section) {
             check_is_sampling<&MppiSettings::iterations>(reading, section, "iterations");
           }},
      {.about = {.name = "temperature",
                 .values = {NumberValue{kPositive}},
                 .words = "λ of the weights exp(−cost/λ)",
                 .unit = "of the cost",
                 .fallback_words = "chosen in every iteration to give `effective_share`"},
       .member = member_of<&MppiSettings::temperature>,
       .check =
           [](const ScenarioReading& reading, Section& section) {
             check_is_sampling<&MppiSettings::temperature>(reading, section, "temperature");
           },
       .is_written =
           [](const Scenario& scenario) { return scenario.controller.mppi.temperature > 0.0; }},
      {.about = {.name = "effective_share",
                 .values = {NumberValue{kShareRange}},
                 .words = "without a temperature: the effective number of samples, (Σw)²/Σw², as a "
                          "share of all"},
       .member = member_of<&MppiSettings::effective_share>,
       .check =
           [](const ScenarioReading& reading, Section& section) {
             check_is_sampling<&MppiSettings::effective_share>(reading, section, "effective_share");
             check_is_used<&MppiSettings::effective_share>(
                 reading, section, "effective_share",
                 reading.scenario.controller.mppi.temperature == 0.0,
                 "no controller.mppi.temperature");
           }},
  };
}

std::vector<ScenarioKey> perturbation_keys() {
  return {
      {.about = {.name = "spread",
                 .values = {NumberValue{kPositive}},
                 .words = "standard deviation of the perturbations, as a share of each input's "
                          "range"},
       .member = member_of<&MppiSettings::spread>,
       .check =
           [](const ScenarioReading& reading, Section& section) {
             check_is_sampling<&MppiSettings::spread>(reading, section, "spread");
           }},
      {.about = {.name = "correlation",
                 .values = {NumberValue{kBelowOneRange}},
                 .words = "correlation of a perturbation with that of the previous period, "
                          "{range}; 0: white"},
       .member = member_of<&MppiSettings::correlation>,
       .check =
           [](const ScenarioReading& reading, Section& section) {
             check_is_sampling<&MppiSettings::correlation>(reading, section, "correlation");
           }},
      {.about = {.name = "control_term",
                 .values = {NumberValue{kUnitRange}},
                 .words = "share of the control term λ uᵀΣ⁻¹ε that is added to the cost"},
       .member = member_of<&MppiSettings::control_term>,
       .check =
           [](const ScenarioReading& reading, Section& section) {
             check_is_sampling<&MppiSettings::control_term>(reading, section, "control_term");
           }},
      {.about = {.name = "smoothing",
                 .values = {kSmoothingRange},
                 .words = "number of periods on either side that the Savitzky-Golay filter of the "
                          "inputs includes, {range}; 0: no filter"},
       .member = member_of<&MppiSettings::smoothing>,
       .check =
           [](const ScenarioReading& reading, Section& section) {
             check_is_sampling<&MppiSettings::smoothing>(reading, section, "smoothing");
             // Through three points the parabola is an interpolation.
             if (reading.scenario.controller.mppi.smoothing == 1) {
               section.note("smoothing", "0, or at least 2");
             }
           }},
  };
}

std::vector<ScenarioKey> unsafe_cost_keys() {
  return {
      {.about = {.name = "obstacle_cost",
                 .values = {NumberValue{kNotNegative}},
                 .words = "cost of each stage at which the body is in the unsafe set"},
       .member = member_of<&MppiSettings::obstacle_cost>,
       .check =
           [](const ScenarioReading& reading, Section& section) {
             check_is_sampling<&MppiSettings::obstacle_cost>(reading, section, "obstacle_cost");
           }},
      optional_key<&MppiSettings::proximity_cost>(
          {.name = "proximity_cost",
           .values = {NumberValue{kNotNegative}},
           .words = "weight of being closer to it than `margin`",
           .fallback_words = "2.5 × `controller.penalty.obstacle`; 400 for `risk_mppi`"}),
      optional_key<&MppiSettings::margin>(
          {.name = "margin",
           .values = {NumberValue{kPositive}},
           .words = "clearance at which that cost begins",
           .unit = "m",
           .fallback_words = "`controller.penalty.length`; 0.5 for `risk_mppi`"}),
  };
}

std::vector<ScenarioKey> sampled_noise_keys() {
  return {
      {.about = {.name = "noise",
                 .values = {FlagValue{}},
                 .words = "for `mppi` only: whether every rollout starts at a sample of the belief "
                          "and has its own process noise"},
       .member = member_of<&MppiSettings::noise>,
       .check =
           [](const ScenarioReading& reading, Section& section) {
             check_is_of<&MppiSettings::noise>(reading, section, "noise", kMppi);
           },
       .is_written =
           [](const Scenario& scenario) { return driving_kind(scenario.controller) == kMppi; }},
      {.about = {.name = "noise_paths",
                 .values = {kNoisePathsRange},
                 .words = "for `risk_mppi` only: number of realisations of belief and noise in "
                          "which every sequence is rolled out"},
       .member = member_of<&MppiSettings::noise_paths>,
       .check =
           [](const ScenarioReading& reading, Section& section) {
             check_is_of<&MppiSettings::noise_paths>(reading, section, "noise_paths", kRiskMppi);
           },
       .is_written =
           [](const Scenario& scenario) { return driving_kind(scenario.controller) == kRiskMppi; }},
      {.about = {.name = "cvar",
                 .values = {NumberValue{kBelowOneRange}},
                 .words = "for `risk_mppi` only: α of the conditional value at risk, the mean of "
                          "the worst 1 − α of the paths"},
       .member = member_of<&MppiSettings::cvar>,
       .check =
           [](const ScenarioReading& reading, Section& section) {
             check_is_of<&MppiSettings::cvar>(reading, section, "cvar", kRiskMppi);
           },
       .is_written =
           [](const Scenario& scenario) { return driving_kind(scenario.controller) == kRiskMppi; }},
  };
}

}  // namespace

ScenarioKey mppi_key() {
  ScenarioKey section{.about = {.name = "mppi"}, .is_written = [](const Scenario& scenario) {
                        return is_sampling(scenario.controller);
                      }};
  for (std::vector<ScenarioKey> (*make)() :
       {sample_keys, perturbation_keys, unsafe_cost_keys, sampled_noise_keys}) {
    for (ScenarioKey& key : make()) section.keys.push_back(std::move(key));
  }
  return section;
}

}  // namespace qsmpc::harness
