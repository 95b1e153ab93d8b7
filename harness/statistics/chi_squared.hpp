// Tails of the chi-squared distribution.
#pragma once

namespace qsmpc::harness {

/// Probability that a chi-squared variable with `degrees` ≥ 1 degrees of freedom exceeds `value` ≥
/// 0; NaN where `value` is not finite. Throws std::domain_error on other arguments.
[[nodiscard]] double chi_squared_tail(double value, int degrees);

}  // namespace qsmpc::harness
