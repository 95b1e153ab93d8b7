// What differs from one vehicle of a kind to the next, drawn once an episode.
#pragma once

#include <cstdint>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// Factors, > 0, on what a plant's file or its system's constants say.
struct PlantVariation {
  double friction = 1.0;   ///< friction coefficients and tyre stiffnesses
  double mass = 1.0;       ///< masses and inertias
  double wheelbase = 1.0;  ///< distances of the axles
};

/// Whether vehicles differ at all.
[[nodiscard]] bool varies(const Scenario::Disturbance& disturbance);

/// The vehicle of an episode: factors e^{σz} with the deviations σ that the scenario's disturbance
/// has and independent standard normal z, from a random stream of their own.
[[nodiscard]] PlantVariation draw_variation(const Scenario::Disturbance& disturbance,
                                            std::uint64_t seed, std::uint64_t episode = 0);

}  // namespace qsmpc::harness
