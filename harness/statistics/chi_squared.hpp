// Tails of the chi-squared law.
#pragma once

namespace qsmpc::harness {

/// Probability that a chi-squared variable with `degrees` ≥ 1 degrees of freedom exceeds `value` ≥
/// 0; not a number where `value` is not finite. Throws std::domain_error for others.
[[nodiscard]] double chi_squared_tail(double value, int degrees);

}  // namespace qsmpc::harness
