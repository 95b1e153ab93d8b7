// The keys of the risk limits.
#include <cmath>

#include "controller/planning/planner_settings.hpp"
#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/known_names.hpp"

namespace qsmpc::harness {
namespace {

constexpr NumberRange kProbability{.least = 0.0, .most = 1.0};
constexpr NumberRange kShare{.least = 0.0, .most = 0.99};

void check_otherwise(const ScenarioReading& reading, Section& section) {
  if (reading.scenario.risk.otherwise == "model" && !reading.scenario.model_error) {
    section.note("otherwise",
                 "least_risk, brake or previous, or a model_error for model to leave out");
  }
  if (reading.scenario.risk.otherwise != "brake" || reading.dynamics == nullptr) return;
  if (controller::speeds_of(*reading.dynamics).empty()) {
    section.note("otherwise",
                 "least_risk or previous, because no state of this system is a speed to brake");
  }
}

ScenarioKey limit_of(const char* name, const char* words, double& (*member)(Scenario&),
                     bool (*is_written)(const Scenario&)) {
  return {.about = {.name = name,
                    .values = {NumberValue{kProbability}},
                    .words = words,
                    .see = "[below](#risk)",
                    .fallback_words = "none"},
          .member = member,
          .is_written = is_written};
}

}  // namespace

ScenarioKey risk_key() {
  return {
      .about = {.name = "risk"},
      .is_written = [](const Scenario& scenario) { return scenario.risk.any(); },
      .keys = {limit_of(
                   "stage",
                   "upper limit on the certified probability that a stage of a plan is unsafe, for "
                   "each stage",
                   [](Scenario& scenario) -> double& { return scenario.risk.stage; },
                   [](const Scenario& scenario) { return std::isfinite(scenario.risk.stage); }),
               limit_of(
                   "plan", "the same for the probability that any stage of a plan is unsafe",
                   [](Scenario& scenario) -> double& { return scenario.risk.plan; },
                   [](const Scenario& scenario) { return std::isfinite(scenario.risk.plan); }),
               limit_of(
                   "mission", "the same for the whole drive",
                   [](Scenario& scenario) -> double& { return scenario.risk.mission; },
                   [](const Scenario& scenario) { return std::isfinite(scenario.risk.mission); }),
               {.about = {.name = "reserve",
                          .values = {NumberValue{kShare}},
                          .words = "share of the limits `stage` and `plan` that plans leave to "
                                   "later ones where they can",
                          .see = "[below](#risk)"},
                .member = [](Scenario& scenario) -> double& { return scenario.risk.reserve; }},
               {.about = {.name = "otherwise",
                          .values = {NameValue{risk_otherwise_names()}},
                          .words = "what to do if no plan within the limits is found: {names}",
                          .see = "[below](#risk)"},
                .member = [](Scenario& scenario) -> std::string& {
                  return scenario.risk.otherwise;
                },
                .check = check_otherwise}},
      .layout = SectionLayout::kFlow,
      .after = ReadAfter::kSystem,
      .table = "risk"};
}

}  // namespace qsmpc::harness
