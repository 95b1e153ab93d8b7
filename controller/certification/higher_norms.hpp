// The orders p, besides the mean square, in which the surrogate's errors are bounded. An error that
// is a few times its root mean square only with a tiny probability has high norms not much above
// it, and P(|e| > t) ≤ (‖e‖_p/t)^p then falls much faster with t than the mean square says.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace qsmpc {

inline constexpr std::array<int, 2> kHigherOrders = {4, 8};

/// One vector for each of kHigherOrders: bounds ‖·‖_p = (E|·|^p)^{1/p} coordinate by coordinate.
using HigherNorms = std::array<Eigen::VectorXd, kHigherOrders.size()>;

/// All norms zero, for vectors of this dimension.
[[nodiscard]] inline HigherNorms zero_norms(Eigen::Index dim) {
  HigherNorms norms;
  norms.fill(Eigen::VectorXd::Zero(dim));
  return norms;
}

/// The norms of polynomials of a standard normal Z that bounds of order p = kHigherOrders[k] need.
struct NormalNorms {
  double first;        ///< ‖Z‖_p
  double first_twice;  ///< ‖Z‖_2p
  double fourth;       ///< ‖Z⁴‖_p
  double fifth;        ///< ‖Z⁵‖_p
  double square;       ///< ‖Z² − 1‖_p
  double cube;         ///< ‖Z³ − 3Z‖_p
};

/// Worked out once. k < kHigherOrders.size().
[[nodiscard]] const NormalNorms& normal_norms(std::size_t k);

}  // namespace qsmpc
