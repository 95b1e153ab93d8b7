// From the costs of samples to their weights, and from costs in many noises to their risk.
#pragma once

#include <span>

#include <Eigen/Core>

namespace qsmpc::controller {

/// Samples as the weights see them.
struct SampleCosts {
  const Eigen::ArrayXd& cost;  ///< S_i; infinite where a rollout was not finite, or not made
  const Eigen::ArrayXd& tilt;  ///< q_i, finite: what weighs in the exponent whatever λ is
};

/// w_i = exp(−S_i / λ − q_i) / Σ_j exp(−S_j / λ − q_j) into `weights`, which is sized by the
/// caller. Returns the effective number of samples, 1 / Σ w²; 0, and weights of 0, where no cost is
/// finite.
double softmin_weights(const SampleCosts& samples, double temperature, Eigen::ArrayXd& weights);

/// The λ > 0 under which `effective` samples, or all of finite cost where these are fewer, carry
/// the weight, to about 1 %. weights: scratch, as above.
[[nodiscard]] double effective_temperature(const SampleCosts& samples, double effective,
                                           Eigen::ArrayXd& weights);

/// The conditional value at risk at level α ∈ [0, 1) of equally likely `values`, which are
/// reordered: min_z z + E(X − z)₊ / (1 − α), the mean of the worst 1 − α of them (Rockafellar and
/// Uryasev 2000).
[[nodiscard]] double conditional_value_at_risk(std::span<double> values, double level);

}  // namespace qsmpc::controller
