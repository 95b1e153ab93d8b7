// NLopt's SLSQP between bounds, for the references of tests: what qsmpc's own solvers are held
// against must not run through them.
#pragma once

#include <functional>
#include <vector>

namespace qsmpc::testing {

struct SlsqpSearch {
  /// Cost at x; writes the gradient, of x's size, unless that is empty.
  std::function<double(const std::vector<double>& x, std::vector<double>& gradient)> cost{};
  std::vector<double> lower{};
  std::vector<double> upper{};
  double relative_tolerance = 0.0;  ///< of the cost
  int evaluations = 0;              ///< at most, or few more
};

/// The last point of a run from `start`, as far as the digits go. What the cost throws passes
/// through; throws std::runtime_error where NLopt fails.
[[nodiscard]] std::vector<double> run_slsqp(const SlsqpSearch& settings, std::vector<double> start);

}  // namespace qsmpc::testing
