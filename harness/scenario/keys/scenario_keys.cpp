#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "harness/scenario/keys/key_text.hpp"
#include "harness/scenario/keys/scenario_key.hpp"

namespace qsmpc::harness {

const std::vector<ScenarioKey>& scenario_keys() {
  static const std::vector<ScenarioKey> keys = [] {
    std::vector<ScenarioKey> all = experiment_keys();
    for (ScenarioKey (*make)() :
         {model_key, plant_key, time_step_key, initial_state_key, disturbance_key, model_error_key,
          safe_set_key, target_key, estimator_key, controller_key, limit_key, video_key}) {
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
    description.values = {std::move(section)};
  }
  if (description.fallback.empty() && !description.required) {
    description.fallback = default_text(key);
  }
  return description;
}

}  // namespace qsmpc::harness
