// The keys of the experiment itself: name, seed, control period and end.
#include "harness/scenario/keys/scenario_key.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kLongestDescription = 500;  // bytes; one line
constexpr NumberRange kPeriodRange{1e-4, 10.0};   // s, from the finest simulator step
constexpr WholeValue kStepsRange{1, 1'000'000};

}  // namespace

std::vector<ScenarioKey> experiment_keys() {
  return {{.about = {.name = "name",
                     .values = {TextValue{.longest = kLongestName, .what = "a name"}},
                     .words = "one line of text, up to {longest} bytes",
                     .required = true},
           .member = [](Scenario& scenario) -> std::string& { return scenario.name; },
           .table = "experiment"},
          {.about = {.name = "description",
                     .values = {TextValue{.longest = kLongestDescription}},
                     .words = "one line of text, up to {longest} bytes",
                     .fallback_words = "empty"},
           .member = [](Scenario& scenario) -> std::string& { return scenario.description; },
           .table = "experiment"},
          {.about = {.name = "seed",
                     .values = {WholeValue{}},
                     .words = "whole number, {range}, that determines all random numbers"},
           .member = [](Scenario& scenario) -> std::uint64_t& { return scenario.seed; },
           .table = "experiment"}};
}

ScenarioKey time_step_key() {
  return {.about = {.name = "time_step",
                    .values = {NumberValue{kPeriodRange}},
                    .words = "control period",
                    .unit = "s"},
          .member = [](Scenario& scenario) -> double& { return scenario.time_step; },
          .table = "experiment"};
}

ScenarioKey limit_key() {
  return {
      .about = {.name = "limit"},
      .keys = {{.about = {.name = "steps",
                          .values = {kStepsRange},
                          .words = "control periods after which an episode ends"},
                .member = [](Scenario& scenario) -> int& { return scenario.step_limit; }},
               {.about = {.name = "stop_when_unsafe",
                          .values = {FlagValue{}},
                          .words =
                              "whether it ends when the true state is unsafe; otherwise it "
                              "continues, and its outcome is still `collision` or `left_bounds`"},
                .member = [](Scenario& scenario) -> bool& { return scenario.stop_when_unsafe; }}},
      .layout = SectionLayout::kFlow,
      .table = "experiment"};
}

}  // namespace qsmpc::harness
