// NLopt's SLSQP within bounds, for reference solutions in tests: references for qsmpc's own solvers
// must not use those solvers.
#pragma once

#include <functional>
#include <vector>

namespace qsmpc::testing {

struct SlsqpSearch {
  /// Cost at x; writes the gradient (of the size of x) unless `gradient` is empty.
  std::function<double(const std::vector<double>& x, std::vector<double>& gradient)> cost{};
  std::vector<double> lower{};
  std::vector<double> upper{};
  double relative_tolerance = 0.0;  ///< of the cost
  int evaluations = 0;              ///< maximum, may be exceeded by a few
};

/// The last point of a run from `start`, as accurate as rounding permits. Exceptions of the cost
/// are passed on; throws std::runtime_error if NLopt fails.
[[nodiscard]] std::vector<double> run_slsqp(const SlsqpSearch& settings, std::vector<double> start);

}  // namespace qsmpc::testing
