// Searches for gains of a mapping with which a plant responds like the planner's model.
#pragma once

#include <optional>

#include "harness/doctor/plant_answers.hpp"
#include "harness/scenario/plant_mapping.hpp"
#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// The mapping used by the plant of `scenario`: the scenario's, or that of its MuJoCo file.
/// Throws InputError where there is none.
[[nodiscard]] PlantMapping mapping_of(const Scenario& scenario);

struct GainSearch {
  PlantMapping mapping;  ///< with the new gains
  PlantAnswers answers;  ///< with that mapping
  bool changed = false;  ///< whether a gain differs from its initial value by more than 2 %
};

/// Scales the gains of `hold` until the vehicle moves as the model does without input, and those of
/// each input under `input` until the state that it acts on first responds as in the model: each by
/// the missing ratio, and repeatedly, since one may affect the other. Goals of feedback loops are
/// scaled likewise, after their responses, where given, are replaced by measured ones. `answers`:
/// those of `scenario`, complete. Throws InputError as plant_answers.
[[nodiscard]] GainSearch search_gains(const Scenario& scenario, const PlantAnswers& answers);

}  // namespace qsmpc::harness
