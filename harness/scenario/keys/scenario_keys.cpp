#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/scenario_text.hpp"
#include "harness/scenario/value_checks.hpp"

namespace qsmpc::harness {

const std::vector<ScenarioKey>& scenario_keys() {
  static const std::vector<ScenarioKey> keys = [] {
    std::vector<ScenarioKey> all = experiment_keys();
    for (ScenarioKey (*make)() :
         {model_key, plant_key, vehicle_key, time_step_key, initial_state_key, disturbance_key,
          model_error_key, safe_set_key, target_key, risk_key, estimator_key, controller_key,
          limit_key, video_key}) {
      all.push_back(make());
    }
    return all;
  }();
  return keys;
}

KeyDescription describe(const ScenarioKey& key) {
  KeyDescription description = key.about;
  if (!key.keys.empty()) {
    MappingValue section;
    for (const ScenarioKey& inner : key.keys) {
      section.keys.push_back(describe(inner));
      description.required = description.required || inner.about.required;
    }
    if (key.word.empty()) {
      description.values = {std::move(section)};
    } else {
      description.values = {TextValue{.what = key.word, .pattern = "^" + key.word + "$"},
                            std::move(section)};
    }
  }
  if (description.fallback.empty() && !description.required) {
    description.fallback = default_text(key);
  }
  return description;
}

void check_safe(const ScenarioReading& reading, Section& section, const char* key,
                const Eigen::VectorXd& point, const controller::SafeSet& safe_set) {
  Eigen::Index largest = 0;
  if (point.cwiseAbs().maxCoeff(&largest) > kLargestCoordinate) {
    section.note(key, fmt::format("numbers of at most {:g} in size", kLargestCoordinate),
                 fmt::format("{:g}", point[largest]));
    return;
  }
  const auto problem = why_unsafe(point, safe_set, reading.system().states);
  if (problem) section.note(key, "a state in the safe set", *problem);
}

void check_variances(Section& section, const char* key, const Eigen::MatrixXd& covariance) {
  if (const auto problem = tiny_variance(covariance)) {
    section.note(key, expected_variances(), *problem);
  }
}

}  // namespace qsmpc::harness
