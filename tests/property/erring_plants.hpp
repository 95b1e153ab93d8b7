// Worst-case plants whose error has known norms.
#pragma once

#include <string>

#include "controller/prediction/model_error.hpp"
#include "controller/prediction/prediction.hpp"
#include "tests/property/random_problem.hpp"
#include "tests/support/simulated_truth.hpp"

namespace qsmpc::testing {

/// A plant's error and its known norms. The norms hold at every moment (period-specific ones at the
/// moments of that period), conditional on any past.
struct ErringPlant {
  std::string kind;
  controller::ModelError norms;
  PlantError error;
};

/// How probabilities without a closed form are estimated from simulated paths.
struct SampledShare {
  int paths = 0;
  double (*upper_limit)(int successes) = nullptr;  ///< of the probability, given `successes` among
                                                   ///< `paths`
};

/// A plant of a random kind: a bias, waves, driven towards the unsafe set, jumping there,
/// heavy-tailed, with a memory of the noise, or lurking next to the unsafe set. Over the horizon
/// its error adds up to between 0.03 and three times the standard deviation of the state. Keeps a
/// reference to `generator`.
[[nodiscard]] ErringPlant random_plant(const Problem& problem,
                                       const controller::PredictedMotion& motion,
                                       const SampledShare& sampled, Generator& generator);

/// `plant`, whose norms hold whatever its past errors, with errors of different size about an
/// offset in each of the first periods of a drive, and small ones later. Its stages start at period
/// `begin`.
[[nodiscard]] ErringPlant setting_out(ErringPlant plant, Eigen::Index begin, Generator& generator);

}  // namespace qsmpc::testing
