// Settings of the controllers "mppi" and "risk_mppi", beside the problem itself.
#pragma once

#include <optional>

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// Names as in Williams, Drews, Goldfain, Rehg, Theodorou: "Information-theoretic model predictive
/// control: theory and applications to autonomous driving", T-RO 34(6), 2018.
struct MppiSettings {
  /// Tuned together with the defaults (docs/scenario.md): plans without feedback need firmer
  /// penalties.
  static constexpr double kFirmness = 2.5;

  int samples = 1024;  ///< S, input sequences per iteration, ≥ 2
  int iterations = 1;  ///< updates of the inputs per period, ≥ 1
  /// λ in the unit of the cost, > 0; 0: chosen in every iteration so that the effective number of
  /// samples (Σw)² / Σw² is `effective_share` of S.
  double temperature = 0.0;
  double effective_share = 0.005;  ///< in (0, 1]
  /// Standard deviation of the perturbations, as a share of each input's range upper − lower, > 0.
  double spread = 0.2;
  /// Correlation ρ of the perturbations along the horizon, ε_k = ρ ε_{k−1} + √(1 − ρ²) ξ_k; 0 for
  /// white noise, < 1.
  double correlation = 0.9;
  /// γ / λ: share of the control term λ uᵀΣ⁻¹ε that is charged, from 0 to 1.
  double control_term = 0.0;
  /// Half the window of the Savitzky-Golay filter of the inputs, in periods, ≥ 0; 0 for none.
  int smoothing = 0;
  double obstacle_cost = 1000.0;  ///< C, for every stage in the unsafe set, ≥ 0
  /// W ≥ 0 and ℓ > 0 (m): a clearance s costs W h(s/ℓ). By default, "mppi" takes the length of the
  /// problem's penalty and kFirmness times its obstacle weight, which stands in for the noise that
  /// it ignores; "risk_mppi" takes weight and length of Penalty{}.
  std::optional<double> proximity_cost{};
  std::optional<double> margin{};
  bool noise = false;    ///< "mppi": whether every rollout has its own noise
  int noise_paths = 16;  ///< "risk_mppi": M, realisations of the noise for every sequence
  double cvar = 0.8;     ///< "risk_mppi": α, in [0, 1)

  bool operator==(const MppiSettings&) const = default;
};

/// Throws std::invalid_argument on numbers out of the ranges above.
void check_mppi_settings(const MppiSettings& settings);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
