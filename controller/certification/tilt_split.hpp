// Splits a law of the path's noise into narrower ones, along the functional of the noise whose
// knowledge makes the motion most nearly affine. Derivation: docs/theory/conditioning.md.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/certification/affine_surrogate.hpp"
#include "controller/certification/path_tilt.hpp"
#include "controller/parallel.hpp"
#include "controller/prediction/prediction.hpp"

namespace qsmpc::controller {

/// For every event of the path, P(event) ≤ left_out + Σ weights_i P_i(event), with P that of the
/// law that is split and P_i that of parts[i].
struct TiltSplit {
  std::vector<PathTilt> parts{};
  Eigen::VectorXd weights{};
  double left_out = 0.0;
};

/// The split of the law `tilt` (empty: the untilted one) into at most `most` parts that reduces the
/// surrogate's errors most, relative to the deviations of `untilted`, the surrogate of the untilted
/// law. Without parts if no split gains enough. The result does not depend on `run`.
[[nodiscard]] TiltSplit best_split(const PredictedMotion& motion, const PathTilt& tilt,
                                   const std::vector<SurrogateStage>& untilted, double most,
                                   const Executor& run);

}  // namespace qsmpc::controller
