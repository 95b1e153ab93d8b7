// The weights of samples from their costs, and the risk of costs over many noise realisations.
#pragma once

#include <span>

#include <Eigen/Core>

namespace qsmpc::controller {

/// Costs and tilts of the samples, from which weights are computed.
struct SampleCosts {
  const Eigen::ArrayXd& cost;  ///< S_i; infinite where a rollout was not finite, or skipped
  const Eigen::ArrayXd& tilt;  ///< q_i, finite: term of the exponent that does not depend on λ
};

/// w_i = exp(−S_i / λ − q_i) / Σ_j exp(−S_j / λ − q_j) into `weights` (sized by the caller).
/// Returns the effective number of samples, 1 / Σ w². If no cost is finite, returns 0 and sets all
/// weights to 0.
double softmin_weights(const SampleCosts& samples, double temperature, Eigen::ArrayXd& weights);

/// The λ > 0 for which the effective number of samples is `effective`, or the number of samples of
/// finite cost if that is lower, to about 1 %. weights: scratch, as above.
[[nodiscard]] double effective_temperature(const SampleCosts& samples, double effective,
                                           Eigen::ArrayXd& weights);

/// The conditional value at risk at level α ∈ [0, 1) of equally likely `values` (reordered in
/// place): min_z z + E(X − z)₊ / (1 − α), the mean of the worst 1 − α of them (Rockafellar and
/// Uryasev 2000).
[[nodiscard]] double conditional_value_at_risk(std::span<double> values, double level);

}  // namespace qsmpc::controller
