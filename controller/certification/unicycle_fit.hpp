// One step of a unicycle near a Gaussian: its best affine map, and bounds on the residual.
// Derivation: docs/theory/surrogate.md, section 3.
#pragma once

#include <Eigen/Core>

#include "controller/certification/saturation.hpp"
#include "controller/certification/statistical_linearisation.hpp"
#include "controller/measure/measures.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

/// The feedback that steers a unicycle, and how far its heading may be from the mean.
struct UnicycleFeedback {
  Eigen::RowVectorXd gain;   ///< of the steering input, 1 x n
  SaturationFit saturation;  ///< of this input
  double away = 0.0;         ///< rad, over the region
};

/// Fills `fit` for the step of `unicycle` from `law`, except for the clamp's residual: replaces
/// e^{iφ} by its best affine fit e^{im − v/2}(1 + i(φ − m)). On entry the vectors of `fit` are
/// zero, of size n.
void fit_unicycle(const models::UnicycleStructure& unicycle, const Gaussian& law,
                  const UnicycleFeedback& feedback, Eigen::Index inputs,
                  StatisticalLinearisation& fit);

}  // namespace qsmpc::controller
