// The expected cost with few points, corrected to the one with all of them.
//
// A solver may need a hundred evaluations to reach the minimum, and with all points each costs a
// pass through maps of points x parts of the noise. The cost with few points has nearly the same
// curvature; corrected by a linear function so that its value and gradient at the current plan are
// those with all points, it leads nearly to the same minimum, and from the next plan, nearer still
// (first-order consistent models: Alexandrov, Dennis, Lewis and Torczon 1998).
#pragma once

#include <memory>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/planning/belief_quantiser.hpp"
#include "controller/planning/cost/horizon_cost.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/prediction/propagator.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

class CoarseCost {
 public:
  /// Whether it would be much cheaper than the cost with the settings' points.
  [[nodiscard]] static bool pays(const PlannerSettings& settings);

  /// Keeps references to `dynamics`, `settings`, and what `terms` refers to.
  CoarseCost(const models::Dynamics& dynamics, const PlannerSettings& settings,
             const HorizonCostTerms& terms);

  /// Predicts with few points under `policy`, and holds the assignments.
  void hold(const Gaussian& belief, const Policy& policy);

  /// Corrects the cost to have, at the decision z, this value and gradient. Returns false, without
  /// a correction, if it is not finite there.
  [[nodiscard]] bool match(const Eigen::VectorXd& z, double value, const Eigen::VectorXd& gradient);

  /// The corrected cost at the decision z of HorizonCost, and its gradient; sized by the caller.
  double evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& gradient);
  /// The same without the gradient.
  double evaluate(const Eigen::VectorXd& z);

 private:
  const models::Dynamics& dynamics_;
  const PlannerSettings& settings_;
  Eigen::MatrixXd within_;  // covariance that the belief's quantiser loses
  BeliefQuantiser quantiser_;
  std::unique_ptr<Propagator> propagator_;
  HorizonCost cost_;
  GaussianQuantisation belief_;
  PredictionScratch scratch_;
  Prediction prediction_;
  Eigen::VectorXd slope_;  // of the correction
  double constant_ = 0.0;  // of the correction
};

}  // namespace qsmpc::controller
