// NLopt's limited-memory BFGS, with the inputs kept in their bounds by a sigmoid (Eq. 5-3).
#pragma once

#include "controller/planning/ocp_solver.hpp"

namespace qsmpc {

class LbfgsSolver final : public OcpSolver {
 public:
  [[nodiscard]] SolverResult minimise(const CostFunction& cost, const Eigen::MatrixXd& start,
                                      const InputBounds& bounds,
                                      const SolverOptions& options) const override;
};

}  // namespace qsmpc
