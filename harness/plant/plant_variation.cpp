#include "harness/plant/plant_variation.hpp"

#include <cmath>

#include "models/random/random_numbers.hpp"

namespace qsmpc::harness {

bool varies(const Scenario::Disturbance& disturbance) {
  return disturbance.friction > 0.0 || disturbance.mass > 0.0 || disturbance.wheelbase > 0.0;
}

PlantVariation draw_variation(const Scenario::Disturbance& disturbance, std::uint64_t seed,
                              std::uint64_t episode) {
  const Eigen::VectorXd normal = models::standard_normal_sample(
      3,
      {.seed = seed, .episode = episode, .stream = models::RandomStream::kParameters, .step = 0});
  return {.friction = std::exp(disturbance.friction * normal[0]),
          .mass = std::exp(disturbance.mass * normal[1]),
          .wheelbase = std::exp(disturbance.wheelbase * normal[2])};
}

}  // namespace qsmpc::harness
