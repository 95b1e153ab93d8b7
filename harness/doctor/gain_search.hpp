// Gains of a mapping with which a plant answers as the planner's model does.
#pragma once

#include <optional>

#include "harness/doctor/plant_answers.hpp"
#include "harness/scenario/plant_mapping.hpp"
#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// The mapping that the plant of `scenario` uses: the scenario's, or that of its MuJoCo file.
/// Throws InputError where there is none.
[[nodiscard]] PlantMapping mapping_of(const Scenario& scenario);

struct GainSearch {
  PlantMapping mapping;  ///< with the gains that were found
  PlantAnswers answers;  ///< with it
  bool changed = false;  ///< whether a gain differs from those at the start by more than 2 %
};

/// Scales the gains of `hold` until the vehicle moves by itself as the model does, and those of
/// each input under `input` until the state that it acts on first answers as the model's: each by
/// the ratio that is missing, and again, since one may change the other. Goals of feedback loops
/// are scaled likewise, after their responses, where given, are measured instead. `answers`: those
/// of `scenario`, complete. Throws InputError as plant_answers.
[[nodiscard]] GainSearch search_gains(const Scenario& scenario, const PlantAnswers& answers);

}  // namespace qsmpc::harness
