// The best affine fit of a clamped Gaussian: what a saturated feedback does to a Gaussian state.
#pragma once

#include <array>

#include "controller/certification/higher_order_norms.hpp"

namespace qsmpc::controller {

/// sat(ℓ) = mean + slope (ℓ − E ℓ) + q for ℓ ~ N(m, s²), with E q = 0 and E[q (ℓ − m)] = 0.
struct SaturationFit {
  double mean = 0.0;      ///< E sat(ℓ), within the bounds
  double slope = 0.0;     ///< P(lower < ℓ < upper), by Gaussian integration by parts
  double residual = 0.0;  ///< bounds √E q² from above, with allowances for cancellation
};

/// The fit of the clamp to [lower, upper] (lower < upper, finite) under N(mean, deviation²).
/// deviation = 0 gives the clamp of the mean, and slope 1 strictly inside the bounds.
[[nodiscard]] SaturationFit fit_saturation(double mean, double deviation, double lower,
                                           double upper);

/// Upper bounds of ‖q‖_p = (E|q|^p)^{1/p}, p in kHigherOrders, for the fit's residual q under
/// N(mean, deviation²), with the same bounds of the clamp; by quadrature of a piecewise polynomial
/// times the normal density, with allowances for its error. Infinite where mean or deviation is not
/// finite.
[[nodiscard]] std::array<double, kHigherOrders.size()> saturation_residual_norms(
    const SaturationFit& fit, double mean, double deviation, double lower, double upper);

/// sup |sat(m + s) − fit.mean − fit.slope s| over |s| ≤ reach, with the same bounds.
[[nodiscard]] double largest_saturation_residual(const SaturationFit& fit, double mean,
                                                 double reach, double lower, double upper);

}  // namespace qsmpc::controller
