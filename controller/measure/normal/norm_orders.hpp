// The orders p, besides the mean square, in which errors are bounded. An error that is a few times
// its root mean square only with a tiny probability has high norms not much above it, and
// P(|e| > t) ≤ (‖e‖_p/t)^p then falls much faster with t than the mean square says.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#pragma GCC visibility push(default)

namespace qsmpc::controller {

inline constexpr std::array<int, 2> kHigherOrders = {4, 8};

/// One vector for each of kHigherOrders: bounds ‖·‖_p = (E|·|^p)^{1/p} coordinate by coordinate.
using HigherNorms = std::array<Eigen::VectorXd, kHigherOrders.size()>;

/// All norms the same, for vectors of this dimension.
[[nodiscard]] inline HigherNorms constant_norms(Eigen::Index dim, double value) {
  HigherNorms norms;
  norms.fill(Eigen::VectorXd::Constant(dim, value));
  return norms;
}

}  // namespace qsmpc::controller

#pragma GCC visibility pop
