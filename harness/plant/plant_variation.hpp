// Random variation between vehicles of a kind, drawn once per episode.
#pragma once

#include <cstdint>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// Factors, > 0, relative to the plant's file or its system's constants.
struct PlantVariation {
  double friction = 1.0;   ///< friction coefficients and tyre stiffnesses
  double mass = 1.0;       ///< masses and inertias
  double wheelbase = 1.0;  ///< distances of the axles
};

/// Whether any variation is configured.
[[nodiscard]] bool varies(const Scenario::Disturbance& disturbance);

/// The vehicle of an episode: factors e^{σz} with the standard deviations σ of the scenario's
/// disturbance and independent standard normal z, from a separate random stream.
[[nodiscard]] PlantVariation draw_variation(const Scenario::Disturbance& disturbance,
                                            std::uint64_t seed, std::uint64_t episode = 0);

}  // namespace qsmpc::harness
