// The table of available plants.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/plant/plant.hpp"
#include "harness/plant/plant_variation.hpp"
#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// An entry of `qsmpc list plants`.
struct PlantEntry {
  std::string name;
  std::string summary;  ///< one line
};

[[nodiscard]] const std::vector<PlantEntry>& plants();

/// The plant that `scenario.plant` names, for the scenario's system, control period and kind of
/// disturbance. Throws InputError on an unknown kind, on a kind of disturbance or a variation that
/// the plant does not support, and as the plant's own maker: see make_mujoco_plant and
/// make_dynamics.
[[nodiscard]] std::unique_ptr<Plant> make_plant(const Scenario& scenario,
                                                const PlantVariation& variation = {});

/// The digest of a plant's files: `mujoco_model_digest` of its vehicle; empty for a plant without
/// files. Throws as mujoco_model_digest.
[[nodiscard]] std::string plant_digest(const Scenario& scenario);

}  // namespace qsmpc::harness
