// A Gaussian process beside the model's state: z_{k+1} = A_k z_k + b_k + w_k with z_0 = x_0 and the
// same noise; known offsets of a plant are in b_k. Its laws are exactly Gaussian; what separates it
// from the state is bounded in mean square, coordinate by coordinate. Bounds C3 and C4 are made
// from it, and the regions on which models without a global Lipschitz constant have one. Where the
// motion has a model error, x is the plant's state. Derivation: docs/theory/surrogate.md.
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
  Eigen::MatrixXd transition;  ///< A, to the next stage; empty at the last and once all is lost
  Eigen::VectorXd error;       ///< bounds √E[(x_i − z_i)²; inside], coordinate by coordinate
  HigherNorms higher;          ///< the same for (E[|x_i − z_i|^p; inside])^{1/p}
  Eigen::VectorXd largest;  ///< bounds |x_i − z_i| in the event that is inside at the next stage
  double leaving = 0.0;     ///< bounds P(not inside)
  Box region;               ///< x is here in the event that is inside at the next stage
};

/// The surrogates of stages 0 … horizon of `motion`. Norms of higher order are infinite where those
/// of the model error are unknown. Where nothing finite is known (a pole in
/// reach, a system without derivative bounds, entries that are not finite) `error` is infinite,
/// `leaving` is 1 and `region` everything, from there on. tilt: all of this under the tilted law of
/// the noise; for motions without a model error.
[[nodiscard]] std::vector<SurrogateStage> affine_surrogates(const PredictedMotion& motion,
                                                            double core = kWideCore,
                                                            const PathTilt& tilt = {});

/// Covariance of a part n of z_stage, as wide as is known, that is independent both of z − n and of
/// (x − z)_axes · 1{inside}: what smooths bounds on the coordinates `axes`. stage ≥ 1;
/// state_dim x state_dim, zero in coordinates that n leaves alone. With a model error it is that of
/// the last noise, the only one of which x − z is independent then. tilt: as above.
[[nodiscard]] Eigen::MatrixXd smoothing_covariance(const PredictedMotion& motion,
                                                   Eigen::Index stage,
                                                   const std::vector<Eigen::Index>& axes,
                                                   const PathTilt& tilt = {});

}  // namespace qsmpc::controller
