// Plants whose error is of known norms and otherwise as bad as it gets.
#pragma once

#include <string>

#include "controller/prediction/model_error.hpp"
#include "controller/prediction/prediction.hpp"
#include "tests/property/random_problem.hpp"
#include "tests/support/simulated_truth.hpp"

namespace qsmpc::testing {

/// A plant's error and what is known of it. The norms hold at every moment, or those of a period at
/// its moments, whatever happened.
struct ErringPlant {
  std::string kind;
  controller::ModelError norms;
  PlantError error;
};

/// How probabilities that no formula gives are taken from simulated paths.
struct SampledShare {
  int paths = 0;
  double (*upper_limit)(int successes) = nullptr;  ///< of the probability, after so many of them
};

/// A plant of a random kind: with a bias, with waves, driven towards the unsafe set, jumping there,
/// heavy-tailed, with a memory of the noise, or lurking by the unsafe set. Over the horizon its
/// error adds up to between 0.03 and three times what the state deviates from its mean. Refers to
/// `generator`.
[[nodiscard]] ErringPlant random_plant(const Problem& problem,
                                       const controller::PredictedMotion& motion,
                                       const SampledShare& sampled, Generator& generator);

/// `plant`, whose norms hold whatever its error did before, with errors of another size about an
/// offset in each of the first periods of a drive, and small ones later. Its stages begin with
/// period `begin`.
[[nodiscard]] ErringPlant setting_out(ErringPlant plant, Eigen::Index begin, Generator& generator);

}  // namespace qsmpc::testing
