// The optimisation of a plan: a solver's run at assignments that are held, then a prediction with
// new ones, and again, as long as it pays.
#pragma once

#include <memory>

#include <Eigen/Core>

#include "controller/planning/plan_evaluator.hpp"
#include "controller/planning/plan_in_progress.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/planning/solvers/ocp_solver.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

class AssignmentRounds {
 public:
  /// Refers to all three. Throws std::invalid_argument on an unknown solver.
  AssignmentRounds(const models::Dynamics& dynamics, const PlannerSettings& settings,
                   PlanEvaluator& evaluator);

  /// Makes plan.current the best plan, evaluated with assignments and gains of its own, from what
  /// it is now, at the assignments that are held: first the inputs are optimised, and then, if
  /// wanted, the gain with them, so that it never costs more. Trouble and a deadline that has
  /// passed are said in plan.status and plan.failed.
  void optimise(PlanInProgress& plan);

 private:
  /// A problem with its solver, and the decision that they work on.
  struct Search {
    OcpProblem problem;
    std::unique_ptr<OcpSolver> solver;
    Eigen::VectorXd z;
    double least = 0.0;  // that the solver has found in its last run, at the assignments held then
  };

  void make_search(Eigen::Index entries, Search& out);
  void start(OcpSolver& solver, bool warm) const;
  [[nodiscard]] bool optimise(Search& search, int rounds, PlanInProgress& plan);
  [[nodiscard]] bool run_solver(Search& search, PlanInProgress& plan);
  void predict_candidate(const Eigen::VectorXd& z, PlanInProgress& plan);

  const models::Dynamics& dynamics_;
  const PlannerSettings& settings_;
  PlanEvaluator& evaluator_;
  Search inputs_;
  std::unique_ptr<Search> gains_;  // over inputs and gains, where these are optimised
  Eigen::MatrixXd gain_change_;    // of a candidate
  double tolerance_ = 0.0;         // that the solver's own is raised to
};

}  // namespace qsmpc::controller
