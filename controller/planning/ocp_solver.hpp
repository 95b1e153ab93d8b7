// Solvers of the optimal control problem: minimise a smooth function over a box of inputs.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "controller/prediction/policy.hpp"

namespace qsmpc {

enum class SolverStatus {
  kConverged,         ///< a tolerance was met
  kIterationLimit,    ///< best point within the allowed evaluations
  kStalled,           ///< the line search found no further descent; best point so far
  kNumericalTrouble,  ///< the cost or its gradient was not finite; best finite point so far
};

/// "converged", "iteration_limit", "stalled" or "numerical_trouble".
[[nodiscard]] const char* solver_status_name(SolverStatus status);

/// Value at `inputs` (input_dim x horizon); writes the gradient, same shape.
using CostFunction =
    std::function<double(const Eigen::MatrixXd& inputs, Eigen::MatrixXd& gradient)>;

struct SolverOptions {
  int max_evaluations = 100;         ///< of cost and gradient, ≥ 1
  double relative_tolerance = 1e-6;  ///< stop when the cost falls by less, relatively
};

struct SolverResult {
  Eigen::MatrixXd inputs;  ///< best found, within the bounds
  double value = 0.0;      ///< cost there; not finite if no finite value was seen
  int evaluations = 0;
  SolverStatus status = SolverStatus::kConverged;
};

class OcpSolver {
 public:
  virtual ~OcpSolver() = default;
  /// Minimises `cost` from `start` (within `bounds`). Never throws for numerical reasons.
  [[nodiscard]] virtual SolverResult minimise(const CostFunction& cost,
                                              const Eigen::MatrixXd& start,
                                              const InputBounds& bounds,
                                              const SolverOptions& options) const = 0;
};

struct SolverEntry {
  std::string name;
  std::string summary;
};

/// The table of solvers.
[[nodiscard]] const std::vector<SolverEntry>& solvers();

/// Throws std::invalid_argument on an unknown name.
[[nodiscard]] std::unique_ptr<const OcpSolver> make_solver(std::string_view name);

}  // namespace qsmpc
