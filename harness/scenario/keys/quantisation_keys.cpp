// The keys of a controller's prediction: its numbers of points and its propagator.
#include <vector>

#include <fmt/format.h>

#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/known_names.hpp"

namespace qsmpc::harness {
namespace {

constexpr WholeValue kPointsRange{1, 100'000};
constexpr const char* kAutoWord = "auto";
constexpr double kAutoTolerance = 1e-3;

/// The default is always allowed, since every resolved scenario contains it.
void check_propagator(const ScenarioReading& reading, Section& section) {
  const Scenario::Controller& controller = reading.scenario.controller;
  const std::string fallback = Scenario::Controller{}.propagator;
  if (!controller.propagate_noise && controller.propagator != fallback) {
    section.note("propagator", fallback + ", or controller.propagate_noise: true");
  }
}

ScenarioKey points_key(const char* name, const char* words, int& (*member)(Scenario& scenario)) {
  return {.about = {.name = name, .values = {kPointsRange}, .words = words}, .member = member};
}

ScenarioKey quantisation_key() {
  return {
      .about = {.name = "quantisation",
                .words =
                    "numbers of points: the keys below, or `auto`, which sets `tolerance` to " +
                    fmt::format("{:g}", kAutoTolerance),
                .see = "[below](#how-many-points)"},
      .keys =
          {points_key(
               "state", "number of points that represent the belief",
               [](Scenario& scenario) -> int& { return scenario.controller.quantisation.state; }),
           points_key(
               "noise",
               "number of points that represent the disturbance, {range}; with `mixture`, the "
               "maximum number of parts that one point's noise is cut into",
               [](Scenario& scenario) -> int& { return scenario.controller.quantisation.noise; }),
           points_key("compressed", "number of points kept after each step of the prediction",
                      [](Scenario& scenario) -> int& {
                        return scenario.controller.quantisation.compressed;
                      }),
           {.about = {.name = "quantiser",
                      .values = {NameValue{quantiser_names()}},
                      .words = "how the points of the belief are computed, a name from `qsmpc list "
                               "quantisers`",
                      .see = "[below](#how-noise-is-predicted)"},
            .member = [](Scenario& scenario) -> std::string& {
              return scenario.controller.quantisation.quantiser;
            }},
           {.about = {.name = "tolerance",
                      .values = {NumberValue{{.least = 0.0, .most = 1.0}}},
                      .words =
                          "for the controller `quantised`: permitted error from using fewer points "
                          "than the above, as a share of a plan's cost, {range}; the belief and "
                          "the prediction use as few points as that allows; 0: all of them",
                      .see = "[below](#how-many-points)"},
            .member = [](Scenario& scenario) -> double& {
              return scenario.controller.quantisation.tolerance;
            },
            .is_written =
                [](const Scenario& scenario) {
                  return scenario.controller.quantisation.tolerance > 0.0;
                }}},
      .word = kAutoWord,
      .say =
          [](Scenario& scenario) { scenario.controller.quantisation.tolerance = kAutoTolerance; },
      .layout = SectionLayout::kFlow};
}

}  // namespace

std::vector<ScenarioKey> prediction_keys() {
  return {
      quantisation_key(),
      {.about = {.name = "propagate_noise",
                 .values = {FlagValue{}},
                 .words = "whether the prediction includes the disturbance"},
       .member = [](Scenario& scenario) -> bool& { return scenario.controller.propagate_noise; }},
      {.about = {.name = "propagator",
                 .values = {NameValue{propagator_names()}},
                 .words = "how the prediction includes the disturbance: {names}",
                 .see = "[below](#how-noise-is-predicted)"},
       .member = [](Scenario& scenario) -> std::string& { return scenario.controller.propagator; },
       .check = check_propagator}};
}

}  // namespace qsmpc::harness
