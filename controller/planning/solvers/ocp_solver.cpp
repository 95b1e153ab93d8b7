#include "controller/planning/solvers/ocp_solver.hpp"

#include <stdexcept>

#include "controller/named_entry.hpp"
#include "controller/planning/solvers/lbfgs_solver.hpp"
#include "controller/planning/solvers/projected_bfgs_solver.hpp"
#include "controller/planning/solvers/slsqp_solver.hpp"

namespace qsmpc::controller {
namespace {

void check(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(std::string("solver: ") + message);
}

template <class Entry>
std::string known_names(const std::vector<Entry>& table) {
  std::string known;
  for (const Entry& entry : table) known += (known.empty() ? "" : ", ") + entry.name;
  return known;
}

std::unique_ptr<OcpSolver> make_lbfgs(const SolverSettings& settings) {
  const std::string& bounding = settings.bounding;
  if (bounding == "bounded") return std::make_unique<ProjectedBfgsSolver>();
  if (bounding == "sigmoid") return std::make_unique<LbfgsSolver>(InputBounding::kSigmoid);
  if (bounding == "tanh") return std::make_unique<LbfgsSolver>(InputBounding::kTanh);
  if (bounding == "penalty") return std::make_unique<LbfgsSolver>(InputBounding::kPenalty);
  throw std::invalid_argument("no input bounding '" + bounding +
                              "'; known: " + known_names(input_boundings()));
}

}  // namespace

const char* solver_status_name(SolverStatus status) {
  switch (status) {
    case SolverStatus::kConverged:
      return "converged";
    case SolverStatus::kIterationLimit:
      return "iteration_limit";
    case SolverStatus::kStalled:
      return "stalled";
    case SolverStatus::kDeadline:
      return "deadline";
    case SolverStatus::kInfeasible:
      return "infeasible";
    case SolverStatus::kRiskExceeded:
      return "risk_exceeded";
    case SolverStatus::kNumericalTrouble:
      return "numerical_trouble";
  }
  return "unknown";
}

const std::vector<SolverEntry>& solvers() {
  static const std::vector<SolverEntry> table = {
      {.name = "lbfgs",
       .summary = "quasi-Newton; the input bounding determines how input bounds are kept",
       .make = make_lbfgs,
       .chooses_bounding = true},
      {.name = "slsqp",
       .summary = "NLopt's sequential quadratic programming; supports inequality constraints",
       .make = [](const SolverSettings&) -> std::unique_ptr<OcpSolver> {
         return std::make_unique<SlsqpSolver>();
       },
       .takes_constraints = true},
  };
  return table;
}

const SolverEntry& solver_entry(std::string_view name) {
  return named_entry(solvers(), name, "solver");
}

const std::vector<InputBoundingEntry>& input_boundings() {
  static const std::vector<InputBoundingEntry> table = {
      {"bounded",
       "inputs held at their bounds: built-in dense BFGS whose steps stay within the box"},
      {"sigmoid", "inputs mapped through a sigmoid (Eq. 5-3), NLopt's limited-memory BFGS"},
      {"tanh", "inputs mapped through a hyperbolic tangent, NLopt's limited-memory BFGS"},
      {"penalty",
       "excess over the bounds penalised, the result clamped, NLopt's limited-memory BFGS"},
  };
  return table;
}

std::unique_ptr<OcpSolver> make_solver(std::string_view name, const SolverSettings& settings) {
  return solver_entry(name).make(settings);
}

void check_problem(const OcpProblem& problem, const Eigen::VectorXd& start,
                   const SolverOptions& options, ConstraintsTaken taken) {
  check(start.size() >= 1, "there are no decision variables");
  check(problem.lower.size() == start.size() && problem.upper.size() == start.size(),
        "bounds and start must have the same size");
  // Comparisons with NaN are false, so NaN is rejected as well.
  check((problem.lower.array() <= problem.upper.array()).all(),
        "lower bounds must not exceed upper bounds");
  check(options.max_evaluations >= 1, "at least one evaluation of the cost is needed");
  if (!problem.constraints) return;
  check(taken == ConstraintsTaken::kInequalities, "this solver does not support constraints");
  const ConstraintSet& set = *problem.constraints;
  check(set.count >= 0 && (set.group.empty() || std::ssize(set.group) == set.count),
        "each constraint must be in a group, or none");
}

}  // namespace qsmpc::controller
