// Prediction and expected cost along a horizon in their plainest form: one struct per particle,
// loops over particles, dense sums, scalar code. Tests compare prediction.hpp and horizon_cost.hpp
// with it.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/planning/cost/horizon_cost.hpp"
#include "controller/prediction/policy.hpp"
#include "models/dynamics/dynamics.hpp"
#include "tests/support/plain_mixture.hpp"

namespace qsmpc::testing {

struct PlainParticle {
  Eigen::VectorXd state;
  double weight = 0.0;
};

/// A particle's new position is Σ share · stepped + offset.
struct PlainShare {
  int source = 0;
  double share = 0.0;
};
struct PlainDestination {
  std::vector<PlainShare> shares;
  Eigen::VectorXd offset;
};

struct PlainPrediction {
  std::vector<std::vector<PlainParticle>> stages;   ///< horizon + 1
  std::vector<std::vector<PlainDestination>> maps;  ///< horizon
  std::vector<double> w2;                           ///< horizon; of the maps
  bool compressed = true;                           ///< whether the maps change anything
};

/// How a stage absorbs the noise: as "mixture" does, or as "noise_free".
struct PlainNoise {
  bool none = false;
  Eigen::MatrixXd covariance;
  int cells = 1;
  int parts = 1;
};

[[nodiscard]] PlainPrediction plain_predict(const models::Dynamics& dynamics,
                                            const controller::DiscreteMeasure& start,
                                            const controller::Policy& policy,
                                            const PlainNoise& noise);

struct PlainCost {
  controller::CostParts parts;
  Eigen::MatrixXd input_gradient;  ///< input_dim x horizon
  Eigen::MatrixXd gain_gradient;   ///< input_dim x state_dim; by a ΔK common to all gains
};

/// The expected cost with the maps of `prediction` held fixed when the nominal inputs become
/// `inputs` and all gains change by `gain_change`, and its gradient by reverse mode. With
/// `optimises_gain` false and all gains zero, the loop counts as open and the clamp has derivative
/// one.
[[nodiscard]] PlainCost plain_cost(const controller::HorizonCostTerms& terms,
                                   const PlainPrediction& prediction,
                                   const controller::Policy& policy, const Eigen::MatrixXd& inputs,
                                   const Eigen::MatrixXd& gain_change, bool optimises_gain);

}  // namespace qsmpc::testing
