// How close a prediction with 100 points comes to the law it stands for, compared with 100 Monte
// Carlo samples: Table 5-1 of the reference thesis.
#pragma once

#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"

namespace qsmpc::testing {

/// The Dubins car at 1.5 m/s and 0.3 rad/s in steps of 0.1 s, from N(0, 0.01 I), open loop.
struct QualityProblem {
  Eigen::MatrixXd noise_covariance;  ///< 3 x 3
  int steps = 9;
};

/// The particles of steps 0 … `steps`: the Lloyd quantiser of the belief with at most `points`
/// points at every step, propagated by the propagator of this name with as many noise points.
[[nodiscard]] std::vector<controller::DiscreteMeasure> quality_prediction(
    const QualityProblem& problem, const std::string& propagator, int points = 100);

/// States of `count` simulated cars at steps 0 … `steps`, equally weighted. Different `stream`s of
/// one seed are independent.
[[nodiscard]] std::vector<controller::DiscreteMeasure> simulated_states(
    const QualityProblem& problem, int count, unsigned seed, unsigned stream);

/// W2² at one step, one entry per seed.
struct SquaredDistances {
  Eigen::ArrayXd monte_carlo;               ///< of 100 samples
  std::vector<Eigen::ArrayXd> predictions;  ///< in the order of the arguments
};

/// The squared distances of `predictions` (steps + 1 measures each) and of `samples` Monte Carlo
/// samples to references of `reference` samples, for seeds 0 … `seeds` − 1; one entry per step.
struct QualitySettings {
  int seeds = 20;
  int samples = 100;
  int reference = 2000;
};
[[nodiscard]] std::vector<SquaredDistances> squared_distances(
    const QualityProblem& problem,
    const std::vector<std::vector<controller::DiscreteMeasure>>& predictions,
    const QualitySettings& settings);

}  // namespace qsmpc::testing
