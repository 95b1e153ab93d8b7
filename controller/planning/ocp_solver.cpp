#include "controller/planning/ocp_solver.hpp"

#include <stdexcept>

#include "controller/planning/lbfgs_solver.hpp"

namespace qsmpc {

const char* solver_status_name(SolverStatus status) {
  switch (status) {
    case SolverStatus::kConverged:
      return "converged";
    case SolverStatus::kIterationLimit:
      return "iteration_limit";
    case SolverStatus::kStalled:
      return "stalled";
    case SolverStatus::kNumericalTrouble:
      return "numerical_trouble";
  }
  return "unknown";
}

const std::vector<SolverEntry>& solvers() {
  static const std::vector<SolverEntry> table = {
      {"lbfgs", "NLopt's limited-memory BFGS; inputs bounded by a sigmoid (Eq. 5-3)"},
  };
  return table;
}

std::unique_ptr<const OcpSolver> make_solver(std::string_view name) {
  if (name == "lbfgs") return std::make_unique<LbfgsSolver>();
  std::string known;
  for (const SolverEntry& entry : solvers()) known += (known.empty() ? "" : ", ") + entry.name;
  throw std::invalid_argument("no solver '" + std::string(name) + "'; known are: " + known);
}

}  // namespace qsmpc
