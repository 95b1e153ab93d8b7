// The keys of the uncertainties: the initial state, the noise and the estimator.
#include <algorithm>

#include <fmt/format.h>

#include "controller/estimation/estimator.hpp"
#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/known_names.hpp"

namespace qsmpc::harness {
namespace {

constexpr NumberRange kDeviationRange{.least = 0.0, .most = 0.5};  // of a logarithm

constexpr std::size_t kMostNoiseSeeds = 10'000;
constexpr std::uint64_t kLastPeriod = 1'000'000;

bool has_sensor_noise(const Scenario& scenario) { return !scenario.disturbance.sensor.isZero(0.0); }

std::string default_estimator(const Scenario& scenario) {
  return has_sensor_noise(scenario) ? "last_measurement" : "exact";
}

/// The standard deviation of a factor drawn once per episode.
ScenarioKey deviation_key(const char* name, const std::string& factor_of,
                          double& (*member)(Scenario& scenario)) {
  return {.about = {.name = name,
                    .values = {NumberValue{kDeviationRange}},
                    .words = "standard deviation, {range}, of the logarithm of a factor on " +
                             factor_of + ", drawn once per episode"},
          .member = member};
}

ScenarioKey sensor_key() {
  return {
      .about = {.name = "sensor",
                .values = {MatrixValue{}},
                .words = "*n* × *n* covariance of the Gaussian noise on the planner's observation "
                         "of the state, drawn anew in every control period",
                .see = "[below](#measurement-noise)",
                .unit = "unit²",
                .fallback_words = "zero: it observes the state exactly"},
      .member = [](Scenario& scenario) -> Eigen::MatrixXd& { return scenario.disturbance.sensor; },
      .check =
          [](const ScenarioReading& reading, Section& section) {
            check_variances(section, "sensor", reading.scenario.disturbance.sensor);
          }};
}

ScenarioKey disturbance_kind_key() {
  return {.about = {.name = "kind",
                    .values = {NameValue{disturbance_kind_names()}},
                    .words = "how the noise of `covariance` acts on the plant: `state`, added to "
                             "the state at the end of the period, or `force`",
                    .see = "[plants](plants.md#disturbances)"},
          .member = [](Scenario& scenario) -> std::string& { return scenario.disturbance.kind; },
          .check =
              [](const ScenarioReading& reading, Section& section) {
                const Scenario& scenario = reading.scenario;
                if (scenario.disturbance.kind == "force" && scenario.plant.kind == "analytic") {
                  section.note("kind", "state, or plant.kind: mujoco");
                }
              }};
}

ListValue noise_seed_list() {
  const KeyDescription from{.name = "from",
                            .values = {WholeValue{0, kLastPeriod}},
                            .words = "a control period",
                            .required = true};
  const KeyDescription seed{.name = "seed", .values = {WholeValue{}}, .required = true};
  return list_of_values(MappingValue{{from, seed}}, {.most = kMostNoiseSeeds});
}

void read_noise_seeds(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  std::vector<models::NoiseSeed>& seeds = reading.scenario.disturbance.seeds;
  const std::size_t count = section.list_size(about.name);
  if (count > kMostNoiseSeeds) {
    section.note(about.name, fmt::format("at most {} seeds", kMostNoiseSeeds));
  }
  for (std::size_t i = 0; i < std::min(count, kMostNoiseSeeds); ++i) {
    Section item = section.item(about.name, i);
    if (item.present()) {
      item.require("from", "a control period");
      item.require("seed", "a whole number");
    }
    const int from = item.whole("from", 0, {0, static_cast<int>(kLastPeriod)});
    const models::NoiseSeed entry{.from = static_cast<std::uint64_t>(from),
                                  .seed = item.seed("seed", 0)};
    item.refuse_unread();
    if (!seeds.empty() && entry.from <= seeds.back().from) {
      item.note("from", fmt::format("a period after {}", seeds.back().from));
    }
    seeds.push_back(entry);
  }
}

std::optional<std::string> noise_seeds_text(const Scenario& scenario,
                                            const models::SystemDescription& /*system*/) {
  std::string text;
  for (const models::NoiseSeed& entry : scenario.disturbance.seeds) {
    text +=
        fmt::format("{}{{from: {}, seed: {}}}", text.empty() ? "" : ", ", entry.from, entry.seed);
  }
  return "[" + text + "]";
}

ScenarioKey noise_seeds_key() {
  return {
      .about = {.name = "seeds",
                .values = {noise_seed_list()},
                .words = "seeds for the noise and the measurement noise that replace `seed`: an "
                         "ascending list of `{from: PERIOD, seed: SEED}`, each valid from its "
                         "control period on; written by campaigns of rare outcomes so that a drive "
                         "that they found can be repeated",
                .see = "[rare outcomes](rare.md)",
                .fallback_words = "none"},
      .read = read_noise_seeds,
      .write = noise_seeds_text,
      .is_written = [](const Scenario& scenario) { return !scenario.disturbance.seeds.empty(); }};
}

}  // namespace

ScenarioKey initial_state_key() {
  return {.about = {.name = "initial_state"},
          .keys = {{.about = {.name = "mean",
                              .values = {VectorValue{}},
                              .words = "*n* numbers; must be safe",
                              .required = true},
                    .member = [](Scenario& scenario) -> Eigen::VectorXd& {
                      return scenario.initial_state.mean;
                    },
                    .check =
                        [](const ScenarioReading& reading, Section& section) {
                          check_safe(reading, section, "mean", reading.scenario.initial_state.mean,
                                     reading.scenario.safe_set);
                        }},
                   {.about = {.name = "covariance",
                              .values = {MatrixValue{}},
                              .words = "*n* × *n* covariance",
                              .unit = "unit²",
                              .fallback_words = "zero: known exactly"},
                    .member = [](Scenario& scenario) -> Eigen::MatrixXd& {
                      return scenario.initial_state.covariance;
                    },
                    .check =
                        [](const ScenarioReading& reading, Section& section) {
                          check_variances(section, "covariance",
                                          reading.scenario.initial_state.covariance);
                        }}},
          .after = ReadAfter::kSystem,
          .table = "plant"};
}

ScenarioKey disturbance_key() {
  return {
      .about = {.name = "disturbance"},
      .keys =
          {{.about = {.name = "covariance",
                      .values = {MatrixValue{}},
                      .words = "*n* × *n* covariance of the Gaussian noise that is added to the "
                               "state in every control period",
                      .unit = "unit²",
                      .fallback_words = "zero: none"},
            .member = [](Scenario& scenario) -> Eigen::MatrixXd& {
              return scenario.disturbance.covariance;
            },
            .check =
                [](const ScenarioReading& reading, Section& section) {
                  check_variances(section, "covariance", reading.scenario.disturbance.covariance);
                }},
           sensor_key(),
           disturbance_kind_key(),
           deviation_key(
               "friction", "the plant's friction and tyre stiffness",
               [](Scenario& scenario) -> double& { return scenario.disturbance.friction; }),
           deviation_key("mass", "the plant's masses and inertias",
                         [](Scenario& scenario) -> double& { return scenario.disturbance.mass; }),
           deviation_key(
               "wheelbase", "the plant's axle distances",
               [](Scenario& scenario) -> double& { return scenario.disturbance.wheelbase; }),
           noise_seeds_key()},
      .after = ReadAfter::kSystem,
      .table = "plant"};
}

ScenarioKey estimator_key() {
  return {
      .about = {.name = "estimator"},
      .keys =
          {{.about = {.name = "kind",
                      .values = {NameValue{estimator_names()}},
                      .words = "how beliefs are formed from observations, a name from `qsmpc list "
                               "estimators`",
                      .fallback_words = "`exact`; with `disturbance.sensor`, `last_measurement`"},
            .member = [](Scenario& scenario) -> std::string& { return scenario.estimator.kind; },
            .read =
                [](ScenarioReading& reading, Section& section, const KeyDescription& about) {
                  reading.scenario.estimator.kind =
                      section.name(about.name, default_estimator(reading.scenario),
                                   value_of<NameValue>(about).known);
                },
            .check =
                [](const ScenarioReading& reading, Section& section) {
                  const Scenario& scenario = reading.scenario;
                  if (has_sensor_noise(scenario) &&
                      controller::estimator_entry(scenario.estimator.kind).needs_exact_sensor) {
                    section.note("kind", default_estimator(scenario) +
                                             ", because disturbance.sensor is not zero");
                  }
                }}},
      .layout = SectionLayout::kFlow,
      .after = ReadAfter::kSystem,
      .table = "measurement"};
}

}  // namespace qsmpc::harness
