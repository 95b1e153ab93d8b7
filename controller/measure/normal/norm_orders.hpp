// The orders p, besides the mean square, in which errors are bounded. If an error exceeds a few
// times its root mean square only with tiny probability, its norms of high order are not much
// larger, and P(|e| > t) ≤ (‖e‖_p/t)^p falls much faster with t than the mean-square bound.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#pragma GCC visibility push(default)

namespace qsmpc::controller {

inline constexpr std::array<int, 2> kHigherOrders = {4, 8};

/// One vector for each of kHigherOrders: bounds ‖·‖_p = (E|·|^p)^{1/p} coordinate by coordinate.
using HigherNorms = std::array<Eigen::VectorXd, kHigherOrders.size()>;

/// All norms equal to `value`, for vectors of dimension `dim`.
[[nodiscard]] inline HigherNorms constant_norms(Eigen::Index dim, double value) {
  HigherNorms norms;
  norms.fill(Eigen::VectorXd::Constant(dim, value));
  return norms;
}

}  // namespace qsmpc::controller

#pragma GCC visibility pop
