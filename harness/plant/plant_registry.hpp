// The table of plants that a scenario may name.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/plant/plant.hpp"
#include "harness/plant/plant_variation.hpp"
#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// What `qsmpc list plants` prints.
struct PlantEntry {
  std::string name;
  std::string summary;  ///< one line
};

[[nodiscard]] const std::vector<PlantEntry>& plants();

/// The plant that `scenario.plant` names, for the scenario's system, control period and kind of
/// disturbance. Throws InputError on an unknown kind, on a kind of disturbance or a variation that
/// the plant does not offer, and whatever the plant's own maker throws: see make_mujoco_plant and
/// make_dynamics.
[[nodiscard]] std::unique_ptr<Plant> make_plant(const Scenario& scenario,
                                                const PlantVariation& variation = {});

/// What a plant's own files come down to: `mujoco_model_digest` of its vehicle; empty for a plant
/// without files. Throws as it does.
[[nodiscard]] std::string plant_digest(const Scenario& scenario);

}  // namespace qsmpc::harness
