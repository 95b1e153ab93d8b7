// A Gaussian surrogate of the model's state: z_{k+1} = A_k z_k + b_k + w_k with z_0 = x_0 and the
// same noise; b_k includes known offsets of a plant. Its laws are exactly Gaussian, and its
// difference from the state is bounded in mean square, coordinate by coordinate. It yields bounds
// C3 and C4, and the regions on which models without a global Lipschitz constant have a local one.
// Where the motion has a model error, x is the plant's state. Derivation: docs/theory/surrogate.md.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/certification/higher_order_norms.hpp"
#include "controller/certification/path_tilt.hpp"
#include "controller/certification/statistical_linearisation.hpp"
#include "controller/measure/measures.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/regions/safe_set.hpp"

namespace qsmpc::controller {

/// The surrogate z of the state x at one stage. "Inside" is an event of probability at least
/// 1 − leaving; it shrinks from stage to stage.
struct SurrogateStage {
  Gaussian law;                ///< of z
  Eigen::MatrixXd with_last;   ///< Cov(z, z of the stage before); empty at the first
  Eigen::MatrixXd transition;  ///< A, to the next stage; empty if last or if nothing is known
  Eigen::VectorXd error;       ///< bounds √E[(x_i − z_i)²; inside], coordinate by coordinate
  HigherNorms higher;          ///< the same for (E[|x_i − z_i|^p; inside])^{1/p}
  Eigen::VectorXd largest;     ///< bounds |x_i − z_i| on the event that the next stage is inside
  double leaving = 0.0;        ///< bounds P(not inside)
  Box region;                  ///< contains x on the event that the next stage is inside
};

/// The surrogates of stages 0 … horizon of `motion`. Norms of higher order are infinite where those
/// of the model error are unknown. From the first stage at which nothing finite is known (a pole
/// within reach, a system without derivative bounds, non-finite entries), `error` is infinite,
/// `leaving` is 1 and `region` is the whole space. tilt: all of this under the tilted law of the
/// noise; only for motions without a model error.
[[nodiscard]] std::vector<SurrogateStage> affine_surrogates(const PredictedMotion& motion,
                                                            double core = kWideCore,
                                                            const PathTilt& tilt = {});

/// Covariance of a part n of z_stage, the widest known, that is independent both of z − n and of
/// (x − z)_axes · 1{inside}: it smooths bounds on the coordinates `axes`. stage ≥ 1;
/// state_dim x state_dim, zero in coordinates that n does not affect. With a model error it is the
/// covariance of the last noise, the only noise of which x − z is then independent. tilt: as above.
[[nodiscard]] Eigen::MatrixXd smoothing_covariance(const PredictedMotion& motion,
                                                   Eigen::Index stage,
                                                   const std::vector<Eigen::Index>& axes,
                                                   const PathTilt& tilt = {});

}  // namespace qsmpc::controller
