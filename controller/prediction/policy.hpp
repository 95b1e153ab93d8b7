// Policies over a horizon (Eq. 4-16, 4-17): u_k(x) = sat(v_k + K_k (x − x̄_k)), where x̄ is the
// noise-free trajectory under the nominal inputs v, and sat clamps to the input bounds. Open loop
// is K = 0.
#pragma once

#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// Closed interval of each input.
struct InputBounds {
  Eigen::VectorXd lower;  ///< input_dim
  Eigen::VectorXd upper;  ///< input_dim, greater than lower
};

/// The input within the bounds that is nearest to zero, input_dim.
[[nodiscard]] inline Eigen::VectorXd resting_input(const InputBounds& bounds) {
  return bounds.lower.cwiseMax(0.0).cwiseMin(bounds.upper);
}

/// `inputs` (input_dim x n), column by column, clamped to the bounds.
template <class Inputs>
void clamp_inputs(const InputBounds& bounds, Inputs&& inputs) {
  for (auto&& input : inputs.colwise()) {
    input = input.cwiseMax(bounds.lower).cwiseMin(bounds.upper);
  }
}

struct Policy {
  Eigen::MatrixXd inputs;              ///< v, input_dim x horizon, within the bounds
  Eigen::MatrixXd states;              ///< x̄, state_dim x (horizon + 1)
  std::vector<Eigen::MatrixXd> gains;  ///< K, horizon of input_dim x state_dim
  InputBounds bounds;

  [[nodiscard]] Eigen::Index horizon() const { return inputs.cols(); }
};

/// The policy's input (input_dim) at one state (state_dim) at stage `stage`.
[[nodiscard]] Eigen::VectorXd policy_input(const Policy& policy, Eigen::Index stage,
                                           const Eigen::Ref<const Eigen::VectorXd>& state);

/// The same into `input`, with `offset` as the caller's scratch; allocates only in the first call.
void policy_input(const Policy& policy, Eigen::Index stage,
                  const Eigen::Ref<const Eigen::VectorXd>& state, Eigen::VectorXd& offset,
                  Eigen::VectorXd& input);

/// The same for every column of `states` (state_dim x n), written to `out` (input_dim x n).
void policy_inputs(const Policy& policy, Eigen::Index stage,
                   const models::Dynamics::BatchView& states, models::Dynamics::BatchOut out);

/// x̄_0 = start, x̄_{k+1} = f(x̄_k, v_k): state_dim x (horizon + 1).
[[nodiscard]] Eigen::MatrixXd nominal_states(const models::Dynamics& dynamics,
                                             const Eigen::Ref<const Eigen::VectorXd>& start,
                                             const Eigen::Ref<const Eigen::MatrixXd>& inputs);

/// The same, written to `out`, whose storage is reused.
void nominal_states(const models::Dynamics& dynamics,
                    const Eigen::Ref<const Eigen::VectorXd>& start,
                    const Eigen::Ref<const Eigen::MatrixXd>& inputs, Eigen::MatrixXd& out);

/// Weights of ½ xᵀQx + ½ uᵀRu, summed over the stages, + ½ xᵀPx at the end.
struct LqrWeights {
  Eigen::MatrixXd state;     ///< Q, positive semidefinite
  Eigen::MatrixXd input;     ///< R, positive definite
  Eigen::MatrixXd terminal;  ///< P, positive semidefinite
};

/// Gains of the time-varying linear-quadratic regulator about the trajectory (states, inputs), by
/// the Riccati recursion: K = −(R + BᵀPB)⁻¹BᵀPA. Not finite where the linearisation is not.
[[nodiscard]] std::vector<Eigen::MatrixXd> lqr_gains(
    const models::Dynamics& dynamics, const Eigen::Ref<const Eigen::MatrixXd>& states,
    const Eigen::Ref<const Eigen::MatrixXd>& inputs, const LqrWeights& weights);

/// Scratch of the recursion; reused, it makes the next one allocation-free.
struct LqrScratch {
  Eigen::MatrixXd a;
  Eigen::MatrixXd b;
  Eigen::MatrixXd value;
  Eigen::MatrixXd cross;
  Eigen::MatrixXd curvature;
  Eigen::MatrixXd closed;
  Eigen::MatrixXd product;
  Eigen::LDLT<Eigen::MatrixXd> ldlt;
};

/// The same, written to `gains`, whose storage is reused.
void lqr_gains(const models::Dynamics& dynamics, const Eigen::Ref<const Eigen::MatrixXd>& states,
               const Eigen::Ref<const Eigen::MatrixXd>& inputs, const LqrWeights& weights,
               LqrScratch& scratch, std::vector<Eigen::MatrixXd>& gains);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
