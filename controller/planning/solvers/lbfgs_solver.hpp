// NLopt's limited-memory BFGS, used without bounds: a change of variables or a penalty keeps them.
#pragma once

#include <limits>

#include "controller/planning/solvers/input_bounding.hpp"
#include "controller/planning/solvers/metered_cost.hpp"
#include "controller/planning/solvers/ocp_solver.hpp"

namespace qsmpc::controller {

class LbfgsSolver final : public OcpSolver {
 public:
  explicit LbfgsSolver(InputBounding bounding) : bounding_(bounding) {}

  const SolverResult& minimise(const OcpProblem& problem, const Eigen::VectorXd& start,
                               const SolverOptions& options) override;

 private:
  // The point of least cost plus penalty, which may lie beyond the bounds.
  struct Trial {
    Eigen::VectorXd z;
    double value = std::numeric_limits<double>::infinity();
  };

  void run(const OcpProblem& problem, const SolverOptions& options, MeteredCost& cost,
           Trial& trial);
  void keep(const Eigen::VectorXd& z, double value);

  InputBounding bounding_;
  SolverResult result_;
};

}  // namespace qsmpc::controller
