// Powers with small whole exponents, which norms of higher order take.
#pragma once

namespace qsmpc::controller {

/// base^exponent, exponent ≥ 0, by repeated multiplication, which takes less time than std::pow.
[[nodiscard]] inline double integer_power(double base, int exponent) {
  double product = 1.0;
  for (int k = 0; k < exponent; ++k) product *= base;
  return product;
}

}  // namespace qsmpc::controller
