// How far the particles can be from the true law of the state (the model's or, where a model error
// is given, the plant's): the 2-Wasserstein error along the horizon, split by its sources.
// Derivation: docs/theory/certificates.md, section 1.
#pragma once

#include <vector>

#include "controller/prediction/prediction.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// W2 error of one stage. `total` bounds the distance between the law of the state and the
/// particles; belief, noise, compression and model say what each source alone would give (their
/// sum is at least the total), and dynamics what would be saved if every L_k above 1 were 1.
struct StageBudget {
  double belief = 0.0;
  double noise = 0.0;
  double compression = 0.0;
  double model = 0.0;     ///< error of the model; 0 without a model error
  double dynamics = 0.0;  ///< how much of the total is due to the dynamics stretching distances
  double total = 0.0;
  double lipschitz = 1.0;  ///< of the closed loop from this stage to the next; 1 at the last stage
  /// W2 between the state and the stepped particles before this stage's noise; 0 at stage 0.
  double before_noise = 0.0;
  /// Where the dynamics have no global Lipschitz constant: bounds the probability that the state
  /// has left the regions on which the constants hold. The distances are then those to the law of
  /// the dynamics projected onto these regions, from which the state's law differs by at most this.
  double leaving = 0.0;
};

/// The budgets of stages 0 … horizon of `motion`. With L_k the Lipschitz constant of the closed
/// loop, global or, where there is none, on the region that `affine_surrogates` gives,
///     ζ_0 = W_belief,  ζ_{k+1} = √((L_k ζ_k + W_projection + W_model)² + W_noise²) +
///     W_compression,
/// with W_model the model error's radius in the stage's period; ζ_0 also includes the radius of the
/// belief's error, if it has one. The cross term vanishes because the noise is independent of the
/// state and of the model error and its quantiser is centroidal; the compression enters by the
/// triangle inequality. W_projection is the cost of particles outside their region, usually zero.
[[nodiscard]] std::vector<StageBudget> error_budget(const PredictedMotion& motion);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
